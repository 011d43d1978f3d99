// Saves what is seen as a PNG: the scene with its words, or the chart. Nothing is asked of any machine.
(() => {
  let view = null; // vtk.js' own, handed down by its component to those within it

  const eye = {
    inject: { held: { from: "view" } },
    created() {
      view = this.held;
    },
    render() {
      return null;
    },
  };

  function loaded(url) {
    return new Promise((done, failed) => {
      const image = new Image();
      image.onload = () => done(image);
      image.onerror = failed;
      image.src = url;
    });
  }

  // Each line of a text as the browser has broken it, at its place on the page.
  function lines(node) {
    const found = [];
    const range = document.createRange();
    for (let k = 0; k < node.data.length; k++) {
      range.setStart(node, k);
      range.setEnd(node, k + 1);
      const place = range.getClientRects()[0];
      if (!place) continue;
      const last = found[found.length - 1];
      if (last && Math.abs(last.place.top - place.top) < 2) last.text += node.data[k];
      else found.push({ text: node.data[k], place });
    }
    return found;
  }

  function paintWords(canvas, stage, root) {
    const home = stage.getBoundingClientRect();
    const walker = document.createTreeWalker(root, NodeFilter.SHOW_TEXT);
    canvas.textBaseline = "middle";
    while (walker.nextNode()) {
      const style = getComputedStyle(walker.currentNode.parentElement);
      canvas.font = `${style.fontWeight} ${style.fontSize} ${style.fontFamily}`;
      canvas.fillStyle = style.color;
      for (const { text, place } of lines(walker.currentNode)) {
        canvas.fillText(text, place.left - home.left, 0.5 * (place.top + place.bottom) - home.top);
      }
    }
  }

  function paintBoxes(canvas, stage, root) {
    const home = stage.getBoundingClientRect();
    for (const box of root.querySelectorAll("[style*=background]")) {
      const place = box.getBoundingClientRect();
      const colours = box.style.background.match(/#[0-9a-f]{6}|rgb\([^)]*\)/gi) || [];
      const gradient = canvas.createLinearGradient(0, place.bottom - home.top, 0, place.top - home.top);
      colours.forEach((colour, k) => gradient.addColorStop(k / Math.max(colours.length - 1, 1), colour));
      canvas.fillStyle = gradient;
      canvas.fillRect(place.left - home.left, place.top - home.top, place.width, place.height);
    }
  }

  function save(url, name) {
    const link = document.createElement("a");
    link.href = url;
    link.download = `${name.replace(/[^\p{L}\p{N}.]+/gu, "_").slice(0, 100) || "picture"}.png`;
    link.click();
  }

  async function saveScene() {
    const stage = document.querySelector(".stage");
    const image = await loaded(await view.captureImage("image/png", {}));
    const paper = document.createElement("canvas");
    paper.width = image.naturalWidth;
    paper.height = image.naturalHeight;
    const canvas = paper.getContext("2d");
    canvas.fillStyle = "#ffffff";
    canvas.fillRect(0, 0, paper.width, paper.height);
    canvas.drawImage(image, 0, 0);
    canvas.scale(paper.width / stage.clientWidth, paper.height / stage.clientHeight);
    for (const root of stage.querySelectorAll(".caption, .bar, .legend")) {
      paintBoxes(canvas, stage, root);
      paintWords(canvas, stage, root);
    }
    save(paper.toDataURL("image/png"), stage.querySelector(".caption").textContent);
  }

  async function saveChart(name) {
    const { data, layout, clientWidth: width, clientHeight: height } = document.querySelector("#chart");
    const white = { ...layout, paper_bgcolor: "#ffffff" };
    save(await window.Plotly.toImage({ data, layout: white }, { format: "png", width, height, scale: 2 }), name);
  }

  window.workbenchPictures = { eye, saveScene, saveChart };
})();
