"""Records in, pictures out: Plotly for the page, matplotlib for paper, PyVista and VTK in space. Knows no question."""
