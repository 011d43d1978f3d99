// A legend that wraps as text does: a click hides or shows a line, a double click shows it alone.
const DASHES = { dash: "7 4", dot: "2 3", dashdot: "7 3 2 3", longdash: "11 4", longdashdot: "11 3 2 3" };
const SHAPES = { circle: "●", square: "■", diamond: "◆", "triangle-up": "▲", cross: "✚", x: "✖", star: "★" };
function legendSymbol(trace) {
  const line = trace.line || {}, marker = trace.marker || {}, mode = trace.mode || "lines";
  if (trace.fill === "toself") return `<rect x="1" y="1" width="28" height="8" fill="${trace.fillcolor}"/>`;
  if (trace.type === "mesh3d") return `<rect x="10" y="0" width="10" height="10" rx="2" fill="${trace.color}"/>`;
  const parts = [];
  if (mode.includes("lines")) {
    parts.push(`<line x1="1" x2="29" y1="5" y2="5" stroke="${line.color || "#555"}" stroke-opacity="${trace.opacity || 1}"
      stroke-width="${Math.min(line.width || 2, 6)}" stroke-dasharray="${DASHES[line.dash] || ""}"/>`);
  }
  if (mode.includes("markers")) {
    const colour = typeof marker.color === "string" ? marker.color : line.color || "#555";
    const shape = SHAPES[(marker.symbol || "circle").replace("-open", "")];
    parts.push(shape ? `<text x="15" y="8.6" text-anchor="middle" font-size="10" fill="${colour}">${shape}</text>`
      : `<path d="M5 5H25M5 1V9M25 1V9" stroke="${colour}" stroke-width="2.5"/>`);
  }
  return parts.join("");
}
function addLegend(box, Plotly, data, place) {
  const named = data.map((trace, k) => ({ trace, k })).filter(({ trace }) => trace.name && trace.showlegend !== false);
  if (named.length < 2) return;
  const holder = document.createElement("div");
  holder.className = "legend";
  const mates = (k) => data.map((t, q) => q).filter((q) => q === k || (data[k].legendgroup && data[q].legendgroup === data[k].legendgroup));
  const off = new Set();
  const show = () => {
    Plotly.restyle(box, { visible: data.map((t, k) => named.some((n) => off.has(n.k) && mates(n.k).includes(k)) ? "legendonly" : true) });
    holder.querySelectorAll("button").forEach((b, q) => b.classList.toggle("off", off.has(named[q].k)));
  };
  for (const { trace, k } of named) {
    const button = document.createElement("button");
    button.type = "button";
    button.innerHTML = `<svg viewBox="0 0 30 10" width="30" height="10" aria-hidden="true">${legendSymbol(trace)}</svg>`;
    button.append(new DOMParser().parseFromString(trace.name, "text/html").body.textContent);
    button.title = "click: hide or show; double click: alone";
    button.addEventListener("click", () => { off.has(k) ? off.delete(k) : off.add(k); show(); });
    button.addEventListener("dblclick", () => {
      const alone = named.every((n) => n.k === k || off.has(n.k));
      off.clear();
      if (!alone) named.forEach((n) => n.k !== k && off.add(n.k));
      show();
    });
    holder.append(button);
  }
  place(holder);
}
