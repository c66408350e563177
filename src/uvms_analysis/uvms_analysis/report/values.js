// Numbers of the page: base64 to typed arrays, lines on common times, what to show of a value.
"use strict";
const values = (() => {
  const kinds = {f4: Float32Array, f8: Float64Array, u2: Uint16Array, u4: Uint32Array};

  function decoded(text, kind) {
    const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
    return new kinds[kind](bytes.buffer);
  }

  const decodedTimes = new Map();
  function timesOf(data, number) {
    if (!decodedTimes.has(number)) decodedTimes.set(number, decoded(data.times[number], "f8"));
    return decodedTimes.get(number);
  }

  // Times and values of one line; null where there is a gap.
  function line(data, given) {
    const all = timesOf(data, given.times);
    const shown = decoded(given.values, "f4");
    const at = given.index ? Array.from(decoded(given.index, given.kind), (k) => all[k])
                           : Array.from(all);
    return [at, Array.from(shown, (v) => (Number.isFinite(v) ? v : null))];
  }

  // The lines of a plot on one axis of times, as uPlot wants them.
  function table(data, plot) {
    const lines = plot.lines.map((given) => line(data, given));
    return lines.length === 1 ? lines[0] : uPlot.join(lines);
  }

  // Value of a column at a time, straight between the samples beside it; null in a gap.
  function at(times, column, time) {
    if (!(time >= times[0] && time <= times[times.length - 1])) return null;
    let low = 0, high = times.length - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (times[middle] <= time) low = middle; else high = middle;
    }
    while (low >= 0 && column[low] === undefined) low -= 1;
    while (high < times.length && column[high] === undefined) high += 1;
    const before = column[low], after = column[high];
    if (times[low] === time && before != null) return before;
    if (times[high] === time && after != null) return after;
    if (before == null || after == null) return null;
    const share = (time - times[low]) / (times[high] - times[low]);
    return before + share * (after - before);
  }

  function text(value) {
    if (value == null) return "–";
    const size = Math.abs(value);
    if (size !== 0 && (size < 1e-3 || size >= 1e6)) return value.toExponential(2);
    return String(Number(value.toPrecision(4)));
  }

  return {table, at, text};
})();
