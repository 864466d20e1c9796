// Plots of the last ten seconds of simulated time, drawn anew with each state.
const WINDOW_MS = 10000;

class History {
  constructor() { this.times = []; this.series = {}; }

  // `values`: name to list, as long as `times`; null where there is none.
  add(times, values) {
    if (this.times.length && times.length && times[0] < this.times[this.times.length - 1]) this.clear();  // a new run
    for (const name of Object.keys(values)) {
      if (!this.series[name]) this.series[name] = new Array(this.times.length).fill(null);
      this.series[name].push(...values[name]);
    }
    this.times.push(...times);
    let old = 0;
    while (old < this.times.length && this.times[old] < this.times[this.times.length - 1] - WINDOW_MS) old++;
    this.times.splice(0, old);
    for (const name of Object.keys(this.series)) this.series[name].splice(0, old);
  }

  clear() { this.times = []; this.series = {}; }

  // Change a millisecond, of the sample before each.
  slope(name) {
    const v = this.series[name] || [];
    return v.map((value, i) => i === 0 || value === null || v[i - 1] === null ? null :
      (value - v[i - 1]) / (this.times[i] - this.times[i - 1]));
  }
}

// `least`: a smaller range than that is not shown larger.
function drawPlot(canvas, times, values, end, least) {
  const scale = window.devicePixelRatio || 1, width = canvas.clientWidth, height = canvas.clientHeight;
  if (width === 0) return;
  if (canvas.width !== Math.round(width * scale)) canvas.width = Math.round(width * scale);
  if (canvas.height !== Math.round(height * scale)) canvas.height = Math.round(height * scale);
  const pen = canvas.getContext("2d"), style = getComputedStyle(canvas);
  pen.setTransform(scale, 0, 0, scale, 0, 0);
  pen.clearRect(0, 0, width, height);
  let low = Infinity, high = -Infinity;
  for (const v of values) if (v !== null) { low = Math.min(low, v); high = Math.max(high, v); }
  if (low > high) low = high = 0;
  const middle = (low + high) / 2, half = Math.max((high - low) / 2, least / 2) * 1.15;
  const y = v => height / 2 - (v - middle) / half * (height / 2 - 1);
  const x = t => width - (end - t) / WINDOW_MS * width;
  pen.lineWidth = 1;
  pen.strokeStyle = style.getPropertyValue("--grid");
  pen.beginPath();
  const second = 1000, first = Math.ceil((end - WINDOW_MS) / second) * second;
  for (let t = first; t <= end; t += second) {
    pen.moveTo(Math.round(x(t)) + 0.5, 0);
    pen.lineTo(Math.round(x(t)) + 0.5, height);
  }
  pen.stroke();
  if (middle - half < 0 && middle + half > 0) {
    pen.strokeStyle = style.getPropertyValue("--zero");
    pen.beginPath();
    pen.moveTo(0, Math.round(y(0)) + 0.5);
    pen.lineTo(width, Math.round(y(0)) + 0.5);
    pen.stroke();
  }
  canvas.plotted = values;
  pen.lineWidth = 1.5;
  pen.lineJoin = "round";
  pen.strokeStyle = style.color;
  pen.beginPath();
  let drawn = false;
  for (let i = 0; i < values.length; i++) {
    if (values[i] === null) { drawn = false; continue; }
    if (drawn) pen.lineTo(x(times[i]), y(values[i]));
    else pen.moveTo(x(times[i]), y(values[i]));
    drawn = true;
  }
  pen.stroke();
}
