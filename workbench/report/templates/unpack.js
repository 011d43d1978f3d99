"use strict";
// Packed parts of the page: gzip in base64, unpacked by the browser itself.
const byteString = (text) => Uint8Array.from(atob(text.trim()), (c) => c.charCodeAt(0));
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
