// The page: plots are made when they come into view, and share one time window and one cursor.
"use strict";
const report = (() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const figures = new Map();  // by key: what is drawn
  const wanted = {from: null, to: null};  // null: the whole run
  const span = data.span.length ? data.span : [0, 1];
  const byId = (name) => document.getElementById(name);

  function windowNow() {
    return [wanted.from ?? span[0], wanted.to ?? span[1]];
  }

  function apply(u) {
    const [min, max] = windowNow();
    if (min !== u.scales.x.min || max !== u.scales.x.max) u.setScale("x", {min, max});
  }

  function show(from, to) {
    [wanted.from, wanted.to] = [from, to];
    const [first, last] = windowNow();
    byId("from").value = Number(first.toFixed(3));
    byId("to").value = Number(last.toFixed(3));
    figures.forEach(({u, isInView}) => { if (isInView) apply(u); });
  }

  // Within the run; all of it is no window.
  function set(from, to) {
    if (from <= span[0] && to >= span[1]) show(null, null);
    else show(Math.max(from, span[0]), Math.min(to, span[1]));
  }

  function zoomed(u, key) {
    const {min, max} = u.scales.x, [from, to] = windowNow();
    if (key !== "x" || !figures.has(u.key) || (min === from && max === to)) return;
    set(min, max);
  }

  // The same instant in every plot in view.
  function point(time) {
    byId("now").textContent = `cursor at ${time.toFixed(2)} s`;
    report.time = time;
    figures.forEach((figure) => { if (figure.isInView) pointIn(figure); });
  }

  function pointIn(figure) {
    figure.u.setCursor({left: figure.u.valToPos(report.time, "x"), top: 10}, false);
    read(figure, report.time);
  }

  function read({plot, u, outputs}, time) {
    outputs.forEach((output, number) => {
      if (!output) return;
      const value = values.at(u.data[0], u.data[number + 1], time);
      output.textContent = `${values.text(value)} ${plot.unit}`;
    });
  }

  function moved(u) {
    if (!u.over.matches(":hover") || !(u.cursor.left >= 0)) return;  // moved by the page itself
    point(u.posToVal(u.cursor.left, "x"));
  }

  function draw(element) {
    const key = element.dataset.plot;
    if (figures.has(key)) return figures.get(key);
    const plot = data.plots[key], canvas = element.querySelector(".canvas");
    if (!canvas.clientWidth) return null;
    const peaks = element.querySelector(".peaks");
    const say = (text) => { peaks.textContent = text; peaks.hidden = !text; };
    const hooks = {setScale: [zoomed], setCursor: [moved]};
    const given = drawing.options(plot, data.marks, canvas.clientWidth, hooks, say);
    const u = new uPlot(given, values.table(data, plot), canvas);
    const figure = {plot, u, element, isInView: true};
    figure.outputs = drawing.legend(element.querySelector(".legend"), plot, (number, on) => {
      u.setSeries(number + 1, {show: on});
      if (plot.lines[number].style === "high") u.setSeries(number + 2, {show: on});
    });
    u.key = key;
    figures.set(key, figure);
    apply(u);
    canvas.addEventListener("keydown", (event) => keyed(figure, event));
    resizing.observe(canvas);
    return figure;
  }

  const resizing = new ResizeObserver((entries) => entries.forEach(({target}) => {
    const figure = figures.get(target.parentElement.dataset.plot);
    const width = target.clientWidth;
    if (figure && width && width !== figure.u.width) {
      figure.u.setSize({width, height: drawing.HEIGHT});
    }
  }));

  function keyed({u}, event) {
    const {min, max} = u.scales.x, width = max - min;
    const now = Math.min(Math.max(report.time ?? (min + max) / 2, min), max);
    const step = (event.shiftKey ? 0.05 : 0.005) * width;
    const zoom = (factor) => {
      set(now - factor * (now - min), now + factor * (max - now));
    };
    const keys = {
      ArrowLeft: () => point(Math.max(now - step, min)),
      ArrowRight: () => point(Math.min(now + step, max)),
      "+": () => zoom(0.5), "=": () => zoom(0.5), "-": () => zoom(2), "−": () => zoom(2),
      Home: () => show(null, null), Escape: () => show(null, null),
    };
    if (event.ctrlKey || event.metaKey || event.altKey || !keys[event.key]) return;
    event.preventDefault();
    keys[event.key]();
  }

  const elements = [...document.querySelectorAll("[data-plot]")];
  const viewing = new IntersectionObserver((entries) => entries.forEach((entry) => {
    const figure = entry.isIntersecting ? draw(entry.target)
                                        : figures.get(entry.target.dataset.plot);
    if (!figure) return;
    figure.isInView = entry.isIntersecting;
    if (!figure.isInView) return;
    apply(figure.u);
    if (report.time != null) pointIn(figure);
  }), {rootMargin: "200px"});

  function drawAll() {
    elements.forEach(draw);
    return figures.size;
  }

  function redraw() {
    figures.forEach(({u}) => u.redraw(false, true));
  }

  // On paper everything is open, light, and as wide as half a page.
  function beforePrint() {
    document.documentElement.dataset.paper = "";
    drawAll();
    figures.forEach(({u}) => {
      apply(u);
      u.setSize({width: 430, height: drawing.HEIGHT});
    });
    redraw();
  }
  function afterPrint() {
    delete document.documentElement.dataset.paper;
    figures.forEach(({u, element}) => {
      const width = element.querySelector(".canvas").clientWidth;
      if (width) u.setSize({width, height: drawing.HEIGHT});
    });
    redraw();
  }

  // What is folded opens and closes; its plots are made when they are seen.
  function fold(button) {
    const isOpen = button.getAttribute("aria-expanded") !== "true";
    button.setAttribute("aria-expanded", String(isOpen));
    button.closest(".fold").classList.toggle("closed", !isOpen);
  }

  function openScene(button) {
    const frame = document.createElement("iframe");
    frame.title = "The run in 3-D";
    const page = new Blob([JSON.parse(byId("scene").textContent)], {type: "text/html"});
    frame.src = URL.createObjectURL(page);
    button.replaceWith(frame);
    frame.focus();
  }

  function start() {
    document.documentElement.classList.add("js");
    document.querySelectorAll(".fold button[aria-expanded]").forEach((button) => {
      button.addEventListener("click", () => fold(button));
    });
    show(null, null);
    elements.forEach((element) => viewing.observe(element));
    const form = document.querySelector(".window");
    form.hidden = !elements.length;
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      const from = Number(byId("from").value), to = Number(byId("to").value);
      const isSpan = byId("from").value && byId("to").value && from < to;
      byId("to").setCustomValidity(isSpan ? "" : "must be later than the beginning");
      if (isSpan) show(from, to); else form.reportValidity();
    });
    byId("to").addEventListener("input", () => byId("to").setCustomValidity(""));
    form.addEventListener("reset", (event) => { event.preventDefault(); show(null, null); });
    const button = byId("open-scene");
    if (button) button.addEventListener("click", () => openScene(button));
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
    addEventListener("beforeprint", beforePrint);
    addEventListener("afterprint", afterPrint);
  }

  return {start, draw, drawAll, figures, point, show, time: null};
})();
report.start();
