// The page's own script: a Plotly chart and the list of curves as Vue components, a curve file sent as text, drags told from clicks.
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

  // Tick boxes by group; the search hides names and leaves ticks as they are.
  const curves = {
    props: ["curves", "chosen"],
    emits: ["update:chosen"],
    data: () => ({ search: "" }),
    computed: {
      found() {
        const words = this.search.toLowerCase().split(/\s+/).filter(Boolean);
        return this.curves.filter((one) => words.every((word) => one.text.toLowerCase().includes(word)));
      },
      groups() {
        return [...new Set(this.found.map((one) => one.group))].map((name) => ({
          name,
          curves: this.found.filter((one) => one.group === name),
        }));
      },
    },
    methods: {
      tick(those, on) {
        const values = those.map((one) => one.value);
        const others = this.chosen.filter((value) => !values.includes(value));
        this.$emit("update:chosen", on ? [...others, ...values] : others);
      },
    },
    template: `
      <input id="curve-search" type="search" v-model="search" placeholder="search, such as: fe 15" aria-label="search curves" />
      <div class="list" id="curves">
        <div v-for="group in groups" :key="group.name" class="group">
          <div class="name">{{ group.name }}
            <button class="link" @click="tick(group.curves, true)">all</button>
            <button class="link" @click="tick(group.curves, false)">none</button>
          </div>
          <label v-for="one in group.curves" :key="one.value">
            <input type="checkbox" :checked="chosen.includes(one.value)" @change="tick([one], $event.target.checked)" />{{ one.text }}
          </label>
        </div>
        <p v-if="!groups.length" class="hint">no such curve</p>
      </div>`,
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
      app.component("workbench-curves", curves);
    },
  };
})();
