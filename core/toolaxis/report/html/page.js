"use strict";
(function () {
  // The viewer's own buttons are named one by one: none that sends data anywhere.
  const settings = {responsive: true, displaylogo: false, plotlyServerURL: "about:blank", displayModeBar: false};
  const turning = {...settings, displayModeBar: true,
    modeBarButtons: [["toImage", "zoom3d", "pan3d", "orbitRotation", "tableRotation", "resetCameraDefault3d"]]};

  // Unsigned little-endian numbers from base64.
  function numbers(text, bytes) {
    const raw = atob(text), found = new Uint16Array(raw.length / bytes);
    for (let k = 0; k < found.length; k++)
      found[k] = bytes === 1 ? raw.charCodeAt(k) : raw.charCodeAt(2 * k) + 256 * raw.charCodeAt(2 * k + 1);
    return found;
  }

  // Pictures come as indices into a table of values and texts.
  function unfold(chart) {
    for (const cells of chart.cells) {
      const index = numbers(cells.index, cells.bytes), [rows, columns] = cells.shape;
      const grid = table => Array.from({length: rows}, (_, i) =>
        Array.from({length: columns}, (_, j) => table[index[i * columns + j]]));
      cells.traces.forEach((trace, k) => {
        chart.figure.data[trace].z = grid(cells.values[k]);
        if (cells.texts) chart.figure.data[trace].text = grid(cells.texts);
      });
    }
    return chart.figure;
  }

  function read(name) {
    const held = document.getElementById("data:" + name);
    return held ? unfold(JSON.parse(held.textContent)) : null;
  }

  function draw(place, name) {
    const figure = read(name);
    place.hidden = !figure;
    if (!figure) { Plotly.purge(place); return; }
    if (window.innerWidth < 600) figure.layout = narrow(figure.layout);
    Plotly.react(place, figure.data, figure.layout, name === "scene" ? turning : settings);
  }

  // On a narrow page titles break and margins shrink.
  function narrow(layout) {
    const title = layout.title && layout.title.text;
    if (title) layout.title = {...layout.title, text: title.replace(/[:;,] /g, found => found[0] + "<br>"), font: {size: 12}};
    layout.margin = {...layout.margin, l: Math.min(layout.margin.l, 45), r: 5};
    layout.font = {...layout.font, size: 11};
    if (layout.scene) layout.legend = {...layout.legend, maxheight: 0.3, font: {size: 11}};
    return layout;
  }

  function turnable() {
    try {
      const canvas = document.createElement("canvas");
      return Boolean(window.WebGLRenderingContext && (canvas.getContext("webgl") || canvas.getContext("webgl2")));
    } catch (reason) { return false; }
  }

  // Charts are drawn when they come near the window, so that the page opens at once.
  const waiting = new IntersectionObserver(entries => {
    for (const entry of entries) {
      if (!entry.isIntersecting) continue;
      waiting.unobserve(entry.target);
      draw(entry.target, entry.target.dataset.chart);
    }
  }, {rootMargin: "300px"});

  if (!turnable()) document.body.classList.add("flat");
  for (const place of document.querySelectorAll("[data-chart]"))
    if (place.dataset.chart !== "scene" || !document.body.classList.contains("flat")) waiting.observe(place);

  const choose = document.getElementById("choose");
  const own = Array.from(document.querySelectorAll("[data-own]"));
  function show() {
    for (const place of own) draw(place, choose.value + ":" + place.dataset.own);
  }
  if (choose) {
    choose.addEventListener("change", show);
    const first = new IntersectionObserver((entries, self) => {
      if (!entries.some(entry => entry.isIntersecting)) return;
      self.disconnect();
      show();
    }, {rootMargin: "300px"});
    first.observe(document.getElementById("each"));
  }

  // For print everything that was not reached yet is drawn first.
  window.addEventListener("beforeprint", () => {
    for (const place of document.querySelectorAll("[data-chart]"))
      if (place.dataset.chart !== "scene" && !place.hasChildNodes()) draw(place, place.dataset.chart);
    if (choose && !own.some(place => place.hasChildNodes())) show();
  });
})();
