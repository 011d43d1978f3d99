"use strict";
// Packed parts of the page: gzip in base64, unpacked by the browser itself.
function byteString(text) {
  const raw = atob(text.trim()), bytes = new Uint8Array(raw.length);
  for (let k = 0; k < raw.length; k++) bytes[k] = raw.charCodeAt(k);
  return bytes;
}
async function unpack(text) {
  const stream = new Blob([byteString(text)]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(stream).text();
}
const dataOf = (name) => document.querySelector(`script[data-for="${CSS.escape(name)}"]`);
let plotly = null;
function withPlotly() {
  plotly ??= unpack(document.getElementById("plotly").textContent).then((code) => {
    const script = document.createElement("script");
    script.textContent = code;
    document.head.append(script);
    return window.Plotly;
  });
  return plotly;
}
const frame = () => new Promise((done) => {
  requestAnimationFrame(() => done());
  setTimeout(done, 100);
});
// Files in the page: a click saves the CSV; without scripts the link saves its gzip.
document.addEventListener("click", async (event) => {
  const link = event.target.closest?.('a[href^="data:application/gzip"]');
  if (!link || !event.isTrusted) return;
  event.preventDefault();
  const saved = document.createElement("a");
  saved.href = URL.createObjectURL(new Blob([await unpack(link.href.split(",")[1])], { type: "text/csv" }));
  saved.download = link.download.replace(/[.]gz$/, "");
  saved.click();
  setTimeout(() => URL.revokeObjectURL(saved.href), 1e4);
});
