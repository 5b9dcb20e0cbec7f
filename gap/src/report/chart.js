// Zoom for the charts of this page: drag for a stretch of x, Shift and drag to move, double click for all of it.
// Charts with the same x go together. The vertical range follows what is in sight.
"use strict";
(() => {
  const W = 960, H = 240, L = 78, R = 8, T = 8, B = 26, NS = "http://www.w3.org/2000/svg";
  const wide = W - L - R, tall = H - T - B;
  const ticks = (low, high, log) => {
    const raw = (high - low) / 6, ten = 10 ** Math.floor(Math.log10(raw));
    let step = [1, 2, 5, 10].map((one) => one * ten).find((one) => one >= raw) || raw;
    if (log) step = Math.max(step, 1);
    const all = [];
    for (let tick = Math.ceil(low / step); tick * step <= high + 1e-9 * step && all.length < 20; tick++) all.push(tick * step);
    return all;
  };
  const label = (tick, log) => {
    const value = log ? 10 ** tick : tick, size = Math.abs(value);
    return size !== 0 && (size < 1e-2 || size >= 1e4) ? value.toExponential(2).replace(/\.?0+e/, "e") : String(Number(value.toFixed(4)));
  };
  const charts = [...document.querySelectorAll("figure.chart")].map((figure) => {
    const svg = figure.querySelector("svg"), data = figure.querySelector(".data"), axes = figure.querySelector(".axes");
    const all = figure.dataset.view.split(" ").map(Number), log = figure.dataset.log === "1";
    const points = [...data.querySelectorAll(".line")].map((line) =>
      line.getAttribute("d").slice(1).split("L").map((pair) => pair.split(" ").map(Number)));
    const px = (x) => L + (x - all[0]) / (all[1] - all[0]) * wide;
    const py = (y) => T + (all[3] - y) / (all[3] - all[2]) * tall;
    const back = (p) => all[3] - (p - T) / tall * (all[3] - all[2]);
    const chart = { figure, svg, name: figure.dataset.name, all, view: all.slice(), log };
    const add = (name, attributes, text) => {
      const node = document.createElementNS(NS, name);
      for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
      if (text !== undefined) node.textContent = text;
      axes.appendChild(node);
    };
    chart.show = (x0, x1) => {
      let [low, high] = [Infinity, -Infinity];
      const [p0, p1] = [px(x0), px(x1)];
      for (const line of points) for (const [x, y] of line) if (x >= p0 && x <= p1) { low = Math.min(low, y); high = Math.max(high, y); }
      const whole = x0 <= all[0] && x1 >= all[1];
      const [y0, y1] = whole || !(high > low) ? [all[2], all[3]] : [back(high), back(low)];
      chart.view = [x0, x1, y0, y1];
      const sx = (all[1] - all[0]) / (x1 - x0), sy = (all[3] - all[2]) / (y1 - y0);
      data.setAttribute("transform", `matrix(${sx} 0 0 ${sy} ${L - sx * p0} ${T - sy * py(y1)})`);
      axes.replaceChildren();
      for (const tick of ticks(x0, x1, log)) {
        const at = L + (tick - x0) / (x1 - x0) * wide;
        add("path", { d: `M${at} ${T}V${H - B}`, class: "grid" });
        add("text", { x: at, y: H - 10, "text-anchor": "middle" }, label(tick, log));
      }
      for (const tick of ticks(y0, y1, log)) {
        const at = T + (y1 - tick) / (y1 - y0) * tall;
        add("path", { d: `M${L} ${at}H${W - R}`, class: "grid" });
        add("text", { x: L - 4, y: at + 4, "text-anchor": "end" }, label(tick, log));
      }
    };
    return chart;
  });
  const together = (chart) => charts.filter((other) => other.name === chart.name);
  for (const chart of charts) {
    const svg = chart.svg;
    const at = (event) => {
      const box = svg.getBoundingClientRect();
      const share = ((event.clientX - box.left) / box.width * W - L) / wide;
      return Math.min(1, Math.max(0, share));
    };
    let from = null, mark = null, start = null;
    svg.addEventListener("pointerdown", (event) => {
      from = at(event); start = chart.view.slice();
      svg.setPointerCapture(event.pointerId);
      if (!event.shiftKey) {
        mark = document.createElementNS(NS, "rect");
        for (const [key, value] of Object.entries({ y: T, height: tall, width: 0, class: "chosen" })) mark.setAttribute(key, value);
        svg.appendChild(mark);
      }
      event.preventDefault();
    });
    svg.addEventListener("pointermove", (event) => {
      if (from === null) return;
      const to = at(event);
      if (mark) {
        mark.setAttribute("x", L + Math.min(from, to) * wide);
        mark.setAttribute("width", Math.abs(to - from) * wide);
      } else {
        const by = (from - to) * (start[1] - start[0]);
        for (const other of together(chart)) other.show(start[0] + by, start[1] + by);
      }
    });
    svg.addEventListener("pointerup", (event) => {
      if (from === null) return;
      const to = at(event), [x0, x1] = chart.view, span = x1 - x0;
      const [a, b] = [Math.min(from, to), Math.max(from, to)];
      if (mark && (b - a) * wide > 4) for (const other of together(chart)) other.show(x0 + a * span, x0 + b * span);
      if (mark) mark.remove();
      from = mark = null;
    });
    svg.addEventListener("dblclick", () => { for (const other of together(chart)) other.show(other.all[0], other.all[1]); });
  }
})();
