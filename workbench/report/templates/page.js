// Printed: everything open, every figure drawn as wide as the paper.
const PAPER = 690;
let folded = [];
window.addEventListener("beforeprint", () => {
  folded = [...document.querySelectorAll("details:not([open])")];
  folded.forEach((one) => { one.open = true; });
  if (!window.Plotly) return;
  document.querySelectorAll(".plot").forEach((box) => {
    drawPlot(box, window.Plotly);
    window.Plotly.relayout(box, { width: PAPER, height: Math.min(box.clientHeight, 400) });
  });
});
window.addEventListener("afterprint", () => {
  folded.forEach((one) => { one.open = false; });
  document.querySelectorAll(".plot").forEach((box) => window.Plotly?.relayout(box, { width: null, height: null, autosize: true }));
});

// Contents: where the reader is; on a narrow screen the list closes behind a choice.
const links = new Map([...document.querySelectorAll(".contents .list a")].map((a) => [a.hash.slice(1), a]));
const here = new IntersectionObserver((entries) => {
  for (const entry of entries.filter((e) => e.isIntersecting && links.has(e.target.id))) {
    links.forEach((a) => a.classList.remove("here"));
    const link = links.get(entry.target.id);
    link.classList.add("here");
    const list = link.parentElement;
    if (list.scrollHeight > list.clientHeight) list.scrollTop = link.offsetTop - list.clientHeight / 2;
  }
}, { rootMargin: "-12% 0px -80% 0px" });
document.querySelectorAll("main section[id]").forEach((section) => here.observe(section));
document.querySelector(".contents .list").addEventListener("click", () => {
  document.getElementById("contents-open").checked = false;
});

// Checks: filtered by word and kind; a link to one opens its fold.
const filter = document.querySelector(".filter");
function applyFilter(kind) {
  if (kind !== undefined) {
    filter.querySelectorAll("button").forEach((b) => b.classList.toggle("on", b.dataset.filter === kind));
    filter.dataset.kind = kind;
  }
  const words = filter.querySelector("input").value.toLowerCase().split(/\s+/).filter(Boolean);
  const classes = (filter.dataset.kind || "").split(" ").filter(Boolean);
  const wanted = (row) => words.every((w) => row.textContent.toLowerCase().includes(w)) &&
    classes.every((c) => c === "bad" ? !row.classList.contains("pass") : row.classList.contains(c));
  let shown = 0;
  document.querySelectorAll("details.checks").forEach((group) => {
    let any = 0;
    group.querySelectorAll("tbody tr").forEach((row) => { row.hidden = !wanted(row); any += !row.hidden; });
    group.hidden = !any;
    group.open = Boolean(any && (words.length || classes.length));
    shown += any;
  });
  filter.querySelector("[role=status]").textContent = words.length || classes.length ? `${shown} shown` : "";
}
if (filter) {
  filter.querySelector("input").addEventListener("input", () => applyFilter());
  filter.querySelectorAll("button").forEach((b) => b.addEventListener("click", () => applyFilter(b.dataset.filter)));
  const shown = new URLSearchParams(location.search).get("show");
  if (shown) applyFilter(shown);
}
function openTarget() {
  const target = location.hash && document.getElementById(decodeURIComponent(location.hash.slice(1)));
  const fold = target && target.closest("details");
  if (fold) { fold.open = true; target.scrollIntoView(); }
}
window.addEventListener("hashchange", openTarget);
openTarget();
