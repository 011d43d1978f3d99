// The page's own script: a Plotly chart as a Vue component, a curve file sent as text, drags told from clicks.
(() => {
  const options = { displayModeBar: false, responsive: true, plotlyServerURL: "" };

  function line(x) {
    return x === null || x === undefined
      ? []
      : [{ type: "line", x0: x, x1: x, y0: 0, y1: 1, yref: "paper", line: { color: "#d81b60", width: 1.5 } }];
  }

  const chart = {
    props: ["figure", "cursor"],
    render() {
      return window.Vue.h("div");
    },
    mounted() {
      this.draw();
      this.observer = new ResizeObserver(() => window.Plotly.Plots.resize(this.$el));
      this.observer.observe(this.$el.parentElement);
    },
    beforeUnmount() {
      this.observer.disconnect();
      window.Plotly.purge(this.$el);
    },
    watch: {
      figure() {
        this.draw();
      },
      cursor() {
        if (this.drawn) window.Plotly.relayout(this.$el, { shapes: line(this.cursor) });
      },
    },
    methods: {
      draw() {
        if (!this.figure) return;
        this.drawn = true;
        const plain = JSON.parse(JSON.stringify(this.figure)); // Plotly writes into what it is given
        window.Plotly.react(this.$el, plain.data, { ...plain.layout, shapes: line(this.cursor) }, options);
      },
    },
  };

  async function sendCurve(event, trame) {
    const [file] = event.target.files;
    if (!file) return;
    trame.trigger("add_curve", [file.name, file.size > 1e6 ? "" : await file.text()]);
    event.target.value = "";
  }

  // A press that moved turned the wheel: it is no click, and probes nothing.
  let pressed = null;
  document.addEventListener("pointerdown", (event) => (pressed = [event.clientX, event.clientY]), true);
  document.addEventListener(
    "click",
    (event) => {
      const moved = pressed && Math.hypot(event.clientX - pressed[0], event.clientY - pressed[1]) > 3;
      if (moved && event.target.closest && event.target.closest(".stage")) event.stopPropagation();
    },
    true,
  );

  window.workbench = {
    sendCurve,
    install(app) {
      app.component("workbench-eye", window.workbenchPictures.eye);
      app.component("workbench-chart", chart);
    },
  };
})();
