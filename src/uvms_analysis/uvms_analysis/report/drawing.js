// One plot: how uPlot draws it, in the colours of the page, with limits, events and a legend.
"use strict";
const drawing = (() => {
  const HEIGHT = 210;
  const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  const COLOURS = 7;
  const nameOf = (number) => (number < 0 ? "--plan" : `--line-${number % COLOURS}`);
  const FONT = "12px system-ui, sans-serif";

  function series(given) {
    const edge = given.style === "high" || given.style === "low";
    const tone = edge ? "--faint" : nameOf(given.colour);
    return {
      label: given.name,
      stroke: () => colour(tone),
      width: given.style === "solid" ? 1.6 : 1.1,
      dash: given.style === "dash" ? [6, 4] : edge ? [2, 3] : undefined,
      points: {show: false},
      spanGaps: false,
    };
  }

  // Between the two edges of a band.
  function bands(plot) {
    const high = plot.lines.findIndex((given) => given.style === "high");
    const low = plot.lines.findIndex((given) => given.style === "low");
    return high < 0 || low < 0 ? [] : [{series: [high + 1, low + 1], fill: () => colour("--band")}];
  }

  function shownValues(u) {
    const [from, to] = [u.scales.x.min, u.scales.x.max];
    const times = u.data[0], found = [];
    for (let k = 0; k < times.length; k += 1) {
      if (from != null && (times[k] < from || times[k] > to)) continue;
      for (let n = 1; n < u.data.length; n += 1) {
        const value = u.series[n].show ? u.data[n][k] : null;
        if (value != null) found.push(value);
      }
    }
    return found;
  }

  // Limits of the vertical axis: no narrower than `least`; a few peaks may lie outside.
  function range(u, plot, say) {
    const found = shownValues(u).sort((a, b) => a - b);
    say("");
    if (!found.length) return [plot.log ? 0.1 : 0, 1];
    let low = found[0], high = found[found.length - 1];
    if (plot.log) {  // whole decades: uPlot does not find the ticks of others
      const lowest = Math.floor(Math.log10(low));
      return [10 ** lowest, 10 ** Math.max(Math.ceil(Math.log10(high)), lowest + 1)];
    }
    if (plot.peaks && found.length > 100) {
      const part = (share) => found[Math.floor(share * (found.length - 1))];
      const inner = Math.max(part(0.997) - part(0.003), plot.least);
      if (high - low > 4 * inner) {
        say(`Peaks from ${values.text(low)} to ${values.text(high)} ${plot.unit} lie outside.`);
        [low, high] = [part(0.003) - 0.5 * inner, part(0.997) + 0.5 * inner];
      }
    }
    const middle = (low + high) / 2, half = Math.max(high - low, plot.least) * 0.54 || 1;
    return [middle - half, middle + half];
  }

  function horizontal(u, value) {
    const y = u.valToPos(value, "y", true);
    if (!(y >= u.bbox.top && y <= u.bbox.top + u.bbox.height)) return;
    u.ctx.moveTo(u.bbox.left, y);
    u.ctx.lineTo(u.bbox.left + u.bbox.width, y);
  }

  function vertical(u, time) {
    const x = u.valToPos(time, "x", true);
    if (!(x >= u.bbox.left && x <= u.bbox.left + u.bbox.width)) return;
    u.ctx.moveTo(x, u.bbox.top);
    u.ctx.lineTo(x, u.bbox.top + u.bbox.height);
  }

  function stroked(u, tone, dash, path) {
    u.ctx.save();
    u.ctx.strokeStyle = colour(tone);
    u.ctx.lineWidth = 1.2 * devicePixelRatio;
    u.ctx.setLineDash(dash.map((part) => part * devicePixelRatio));
    u.ctx.beginPath();
    path();
    u.ctx.stroke();
    u.ctx.restore();
  }

  const axis = (more) => ({
    stroke: () => colour("--faint"),
    grid: {stroke: () => colour("--grid"), width: 1},
    ticks: {stroke: () => colour("--grid"), width: 1},
    font: FONT,
    ...more,
  });

  function options(plot, marks, width, hooks, say) {
    return {
      width, height: HEIGHT, legend: {show: false}, bands: bands(plot), padding: [8, 24, 0, 0],
      series: [{}, ...plot.lines.map(series)],
      scales: {
        x: {time: false},
        y: {distr: plot.log ? 3 : 1, range: (u) => range(u, plot, say)},
      },
      axes: [
        axis({size: 34, values: (u, ticks) => ticks.map((t) => `${values.text(t)} s`)}),
        axis({size: 58, values: (u, ticks) => ticks.map((v) => (v == null ? "" : values.text(v)))}),
      ],
      cursor: {y: false, drag: {x: true, y: false}, points: {show: false}},
      hooks: {
        draw: [(u) => {
          stroked(u, "--limit", [5, 4], () => plot.limits.forEach((l) => horizontal(u, l.value)));
          stroked(u, "--event", [2, 4], () => marks.forEach((mark) => vertical(u, mark.time)));
        }],
        ...hooks,
      },
    };
  }

  // Limits in words: the same one on both sides of zero once.
  function limitsOf(plot) {
    const names = [...new Set(plot.limits.map((limit) => limit.name))];
    return names.map((name) => {
      const found = plot.limits.filter((limit) => limit.name === name).map((limit) => limit.value);
      const isPair = found.length === 2 && found[0] === -found[1];
      const shown = isPair ? [`±${values.text(Math.abs(found[0]))}`] : found.map(values.text);
      return `${name} ${shown.join(", ")} ${plot.unit}`;
    });
  }

  // Buttons that hide lines and say their values at the cursor; limits in words.
  function legend(place, plot, toggle) {
    const outputs = plot.lines.map((given, number) => {
      if (given.style === "low") return null;
      const button = document.createElement("button");
      button.type = "button";
      button.setAttribute("aria-pressed", "true");
      button.title = "hide or show this line";
      const tone = given.style === "high" ? "--faint" : nameOf(given.colour);
      const swatch = document.createElement("i");
      swatch.className = `swatch ${given.style}`;
      swatch.style.setProperty("--tone", `var(${tone})`);
      const output = document.createElement("output");
      button.append(swatch, `${given.name} `, output);
      button.addEventListener("click", () => {
        const on = button.getAttribute("aria-pressed") !== "true";
        button.setAttribute("aria-pressed", String(on));
        toggle(number, on);
      });
      place.append(button);
      return output;
    });
    for (const text of limitsOf(plot)) {
      const word = document.createElement("span");
      word.className = "limit";
      word.textContent = text;
      place.append(word);
    }
    return outputs;
  }

  return {HEIGHT, options, legend};
})();
