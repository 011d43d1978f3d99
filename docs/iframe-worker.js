/* Search without a server: browsers run no worker from a file, so on file: pages the worker's script runs in a hidden
   frame. Same calls as Worker: addEventListener("message"), postMessage, terminate. */
if (location.protocol === "file:") {
  window.Worker = class extends EventTarget {
    constructor(url) {
      super();
      this.frame = document.createElement("iframe");
      this.frame.hidden = true;
      // The worker answers by postMessage(data), which in a frame would reach the frame itself.
      const script = new URL(url, document.baseURI).href.replaceAll('"', "%22");
      this.frame.srcdoc =
        "<script>window.postMessage = (data) => parent.postMessage(data, '*');</script>" +
        `<script src="${script}"></script>`;
      this.ready = new Promise((done) => this.frame.addEventListener("load", done, { once: true }));
      this.listener = (event) => {
        if (event.source !== this.frame.contentWindow) return;
        const message = new MessageEvent("message", { data: event.data });
        this.dispatchEvent(message);
        if (this.onmessage) this.onmessage(message);
      };
      window.addEventListener("message", this.listener);
      document.body.appendChild(this.frame);
    }

    postMessage(data) {
      this.ready.then(() => this.frame.contentWindow.dispatchEvent(new MessageEvent("message", { data })));
    }

    terminate() {
      window.removeEventListener("message", this.listener);
      this.frame.remove();
    }
  };
}
