// Curves that can be zoomed, with values under the pointer, from #curves-data (compare/curve_data.py); by uPlot. Each
// element with data-curves="NAME" gets that plot.
"use strict";
(() => {
  const source = document.getElementById("curves-data");
  if (!source) return;
  const curves = JSON.parse(source.textContent);
  const HEIGHT_PX = 340;

  const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
  const button = (text, title, act) => {
    const made = Object.assign(document.createElement("button"), { type: "button", textContent: text, title });
    made.setAttribute("aria-label", title);
    made.addEventListener("click", act);
    return made;
  };
  const box = (content, act) => {
    const input = Object.assign(document.createElement("input"), { type: "checkbox", checked: true });
    input.addEventListener("change", () => act(input.checked));
    const label = document.createElement("label");
    label.append(input, " ", ...content);
    return label;
  };
  const shown = (plot, value) => (value == null ? "–" : String(Number(value.toPrecision(4))).replace("-", "−"));

  function show(holder, { x_label, y_label, x, engines, spans_gaps: spanGaps }) {
    const axis = { stroke: () => colour("ink"), grid: { stroke: () => colour("line"), width: 1 }, ticks: { stroke: () => colour("line") } };
    const banded = engines.some(({ low }) => low.some((value) => value !== null));
    const series = [{ label: x_label, value: shown }];
    const values = [x];
    const bands = [];
    for (const { engine, colour: own, mean, low, high } of engines) {
      const edge = { stroke: own, width: 0, points: { show: false }, spanGaps, value: shown, class: "edge" };
      bands.push({ series: [series.length + 1, series.length + 2], fill: `${own}33` });
      series.push({ label: engine, stroke: own, width: 2, spanGaps, points: { show: false }, value: shown },
        { label: `${engine}, high`, ...edge }, { label: `${engine}, low`, ...edge });
      values.push(mean, high, low);
    }
    const tools = Object.assign(document.createElement("div"), { className: "controls" });
    const place = document.createElement("div");
    holder.append(tools, place);
    const plot = new uPlot({
      width: place.clientWidth, height: HEIGHT_PX, series, bands,
      scales: { x: { time: false } },
      axes: [{ ...axis, label: x_label }, { ...axis, label: y_label, size: 56 }],
      cursor: { drag: { x: true, y: false } },
    }, values, place);

    let bandsOn = banded;
    const on = engines.map(() => true);
    const apply = () => engines.forEach((_, k) => {
      plot.setSeries(3 * k + 1, { show: on[k] });
      for (const edge of [2, 3]) plot.setSeries(3 * k + edge, { show: on[k] && bandsOn });
    });
    const zoom = (factor) => {
      const { min, max } = plot.scales.x;
      const half = Math.min(((max - min) / 2) * factor, (x.at(-1) - x[0]) / 2);
      const middle = Math.min(Math.max((min + max) / 2, x[0] + half), x.at(-1) - half);
      plot.setScale("x", { min: middle - half, max: middle + half });
    };
    const move = (share) => {
      const { min, max } = plot.scales.x;
      const by = Math.min(Math.max(share * (max - min), x[0] - min), x.at(-1) - max);
      plot.setScale("x", { min: min + by, max: max + by });
    };
    engines.forEach(({ engine, colour: own }, k) => {
      const dot = Object.assign(document.createElement("span"), { className: "dot" });
      dot.style.setProperty("--engine", own);
      tools.append(box([dot, engine], (checked) => { on[k] = checked; apply(); }));
    });
    if (banded) tools.append(box(["bands"], (checked) => { bandsOn = checked; apply(); }));
    tools.append(button("+", "zoom in", () => zoom(0.5)), button("−", "zoom out", () => zoom(2)),
      button("‹", "to the left", () => move(-0.25)), button("›", "to the right", () => move(0.25)),
      button("all", "the whole range", () => plot.setScale("x", { min: x[0], max: x.at(-1) })));
    apply();
    holder.dataset.ready = "yes";
    new ResizeObserver(() => plot.setSize({ width: place.clientWidth, height: HEIGHT_PX })).observe(place);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => plot.redraw());
  }

  for (const holder of document.querySelectorAll("[data-curves]")) {
    const found = curves[holder.dataset.curves];
    if (found) show(holder, found);
  }
})();
