// What happens over time or over the path's length: charts that share that axis and the cursor.

const seriesColors = ['#0072b2', '#d55e00', '#009e73', '#cc79a7', '#e69f00', '#56b4e9', '#666666', '#000000', '#8c6d1f'];
const darkSeriesColors = ['#56b4e9', '#ff8c42', '#2fc79a', '#e6a0c8', '#e69f00', '#3d8bd0', '#a0a4a8', '#ffffff', '#c9a54c'];

// A chart is a title and series, each with a name, a value of a state, and a limit if there is one.
function chartsOf(motion) {
  const limit = x => (isFinite(x ?? Infinity) ? x : undefined);
  const perAxis = (valueOf, order) => motion.axes.map(axis => ({
    name: axis.name, value: valueOf(axis.channel), limit: limit(axis.limits[order])}));
  // Limits hold for the tool's vector; along the path corrections of corners move to and fro. A live run does not tell the vector.
  const tool = (vector, along, order) => (motion instanceof LiveMotion ? {name: 'along the path', value: along} :
    {name: 'tool', value: (s, m) => m.ofTool(s, vector(s)), limit: limit(motion.limits[order])});
  const unit = motion.axes.some(axis => axis.unit === 'deg') ? 'mm or degrees' : 'mm';
  return [
    {title: 'speed along the path, mm/s', series: [
      {name: 'speed', value: s => s.v, limit: limit(motion.velocityLimit)},
      ...(motion.wanted ? [{name: 'programmed', value: (s, m) => m.wanted(s)}] : [])]},
    {title: `velocity, ${unit}/s`, series: perAxis(k => s => s.velocity[k], 0)},
    {title: `acceleration, ${unit}/s²`, series: [...perAxis(k => s => s.acceleration[k], 1), tool(s => s.acceleration, s => s.a, 1)]},
    {title: `jerk, ${unit}/s³`, series: [...perAxis(k => s => s.jerk[k], 2), tool(s => s.jerk, s => s.j, 2)]},
    {title: 'step rate, 1/s', series: motion.axes.map(axis => ({
      name: axis.name, value: s => Math.abs(s.velocity[axis.channel]) * axis.stepsPerUnit}))},
    ...(motion.deviates ? [{title: 'deviation from the programmed path, mm', series: [
      {name: 'deviation', value: (s, m) => m.deviation(s), limit: motion.tolerance || undefined}]}] : []),
  ];
}

// The smallest and the largest values of each column of a picture.
class Columns {
  constructor(from, to, series, count = 1000) {
    Object.assign(this, {from, width: (to - from) / count, count, series, used: new Uint8Array(count)});
    this.low = new Float64Array(count * series).fill(Infinity);
    this.high = new Float64Array(count * series).fill(-Infinity);
  }
  put(x, values) {
    const column = Math.min(Math.max(Math.floor((x - this.from) / this.width), 0), this.count - 1), at = column * this.series;
    this.used[column] = 1;
    for (let k = 0; k < this.series; ++k) {
      if (values[k] < this.low[at + k]) this.low[at + k] = values[k];
      if (values[k] > this.high[at + k]) this.high[at + k] = values[k];
    }
  }
  rows() {
    const rows = [], of = (values, column) => Array.from(
      values.subarray(column * this.series, (column + 1) * this.series), x => (isFinite(x) ? x : NaN));
    for (let column = 0; column < this.count; ++column) {
      if (!this.used[column]) continue;
      rows.push([this.from + column * this.width, ...of(this.low, column)],
                [this.from + (column + 0.5) * this.width, ...of(this.high, column)]);
    }
    return rows;
  }
}

// What charts are drawn over: a place of a state, the time at a place, and where the end is.
const chartAxes = {
  time: {name: 'time, s', of: state => state.time, timeAt: (motion, x) => x, end: motion => motion.duration},
  length: {name: 'path length, mm', of: state => state.s, timeAt: (motion, x) => motion.timeAtLength(x), end: motion => motion.length},
};

// Rows of places and values within a window. Where it holds more than can be drawn, each column of the picture has
// its smallest and its largest value.
function chartRows(motion, series, from, to, axis = chartAxes.time) {
  if (motion.count === 0) return [[0, ...series.map(() => 0)]];
  const columns = new Columns(from, to, series.length), room = motion.room(), rows = [], values = new Float64Array(series.length);
  const begin = axis.timeAt(motion, from), finish = axis.timeAt(motion, to);
  const first = motion.phaseAt(begin), last = motion.phaseAt(finish);
  const whole = 5 * (last - first + 1) <= 3 * columns.count;
  const put = (i, t) => {
    const state = motion.inPhase(i, t, room);
    for (let k = 0; k < series.length; ++k) values[k] = series[k].value(state, motion);
    if (whole) rows.push([axis.of(state), ...values]); else columns.put(axis.of(state), values);
  };
  for (let i = first; i <= last; ++i) {
    const start = Math.max(motion.phase.time[i], begin), end = Math.min(motion.phase.time[i] + motion.durationOf(i), finish);
    const turning = motion.turning(i), seconds = axis === chartAxes.time ? columns.width : (finish - begin) / columns.count;
    const parts = Math.max(whole ? 4 : 1, Math.min(Math.ceil((end - start) / seconds), 4 * columns.count));
    const inside = Math.min(1e-4 * (end - start), 1e-5);
    for (let k = 0; k <= parts; ++k) {
      // a little inside: at its ends a phase may meet the piece of path beside its own
      const t = Math.min(Math.max(start + (end - start) * k / parts, start + inside), end - inside);
      if (turning < t && turning >= t - (end - start) / parts && k > 0) put(i, turning);
      put(i, t);
    }
  }
  const result = whole ? rows : columns.rows();
  return result.length > 0 ? result : [[from, ...series.map(() => 0)]];
}

class Charts {
  constructor(element, marks) {
    this.element = element;
    this.marks = marks;
    this.hovered = () => {};
    this.axis = chartAxes.time;
    this.state = null;
    this.waits = false;  // to be seen before it is filled
    new ResizeObserver(() => { this.fit(); if (this.state) this.put(this.state); }).observe(element);
    new IntersectionObserver(([entry]) => {
      this.seen = entry.isIntersecting;
      if (this.seen) this.fillIfWaiting();
    }).observe(element);
  }

  // `other`: a motion to compare with, or nothing.
  show(motion, other = null) {
    this.motion = motion;
    this.other = other;
    this.element.replaceChildren();
    clearTimeout(this.timer);
    for (const chart of this.charts ?? []) chart.graph.destroy();
    this.charts = undefined;
    const end = Math.max(this.axis.end(motion), other ? this.axis.end(other) : 0);
    this.window = this.all = [0, end > 0 ? end : 1];
    this.state ??= motion.at(0);
    this.filling = true;
    this.charts = chartsOf(motion).map(chart => this.add(chart));
    this.fit();  // they share the room
    this.filling = false;
    this.waits = motion.count > 100000 && !this.seen;
    if (!this.waits) this.fill();
  }
  fillIfWaiting() { if (this.waits) this.fill(); }

  add(chart) {
    const box = document.createElement('div'), heading = document.createElement('h3'), plot = document.createElement('div');
    const cursor = document.createElement('div');
    box.className = 'chart';
    plot.className = 'plot';
    cursor.className = 'cursor';
    box.append(heading, plot);
    this.element.append(box);
    const palette = theme.dark ? darkSeriesColors : seriesColors, colors = chart.series.map((_, k) => palette[k % palette.length]);
    const names = chart.series.map(one => one.name), others = this.other ? names.map(name => `${name}, ${this.other.name}`) : [];
    const zeros = [...names, ...others].map(() => 0);
    const graph = new Dygraph(plot, [[0, ...zeros], [1, ...zeros]], {
      labels: ['x', ...names, ...others], colors: [...colors, ...(this.other ? colors : [])], strokeWidth: 1.5, legend: 'never',
      animatedZooms: false, connectSeparatedPoints: true,
      series: Object.fromEntries(others.map(name => [name, {strokePattern: [2, 3], strokeWidth: 1.2}])),
      axisLabelFontSize: 12, gridLineColor: theme.grid, axisLineColor: theme.faint, highlightCircleSize: 0, axes: {y: {axisLabelWidth: 70, pixelsPerLabel: 22}},
      underlayCallback: (context, area, g) => this.underlay(context, area, g, chart, colors),
      zoomCallback: (from, to) => this.zoom(from, to),
      drawCallback: g => this.follow(g),
    });
    plot.append(cursor);
    plot.addEventListener('mousemove', event => {
      if (event.buttons !== 0) return;
      const x = graph.toDataXCoord(event.clientX - plot.getBoundingClientRect().left);
      if (x >= 0 && x <= this.axis.end(this.motion)) this.hovered(this.axis.timeAt(this.motion, x));
    });
    plot.addEventListener('wheel', event => {
      event.preventDefault();
      this.zoomAbout(graph.toDataXCoord(event.clientX - plot.getBoundingClientRect().left), Math.exp(event.deltaY * 0.001));
    }, {passive: false});
    plot.addEventListener('dblclick', () => this.zoom(...this.all));
    return {...chart, colors, heading, graph, cursor};
  }

  // Limits as dashed lines, marks as vertical ones.
  underlay(context, area, graph, chart, colors) {
    context.save();
    context.setLineDash([6, 4]);
    chart.series.forEach((one, k) => {
      if (one.limit === undefined) return;
      context.strokeStyle = colors[k];
      for (const y of [one.limit, -one.limit].map(value => graph.toDomYCoord(value))) {
        context.beginPath();
        context.moveTo(area.x, y);
        context.lineTo(area.x + area.w, y);
        context.stroke();
      }
    });
    context.setLineDash([]);
    context.strokeStyle = context.fillStyle = theme.faint;
    context.font = '12px sans-serif';
    for (const mark of this.marks) {
      const x = graph.toDomXCoord(this.axis.of(this.motion.at(mark.time)));
      context.strokeRect(x, area.y, 0, area.h);
      context.fillText(mark.text, x + 3, area.y + 11);
    }
    context.restore();
  }

  zoomAbout(x, factor) {
    const [from, to] = this.window;
    this.zoom(x - (x - from) * factor, x + (to - x) * factor);
  }
  zoomAtCursor(factor) { this.zoomAbout(this.axis.of(this.state), factor); }
  zoom(from, to) {
    const least = 1e-6;
    from = Math.max(from, this.all[0]);
    to = Math.min(Math.max(to, from + least), this.all[1]);
    this.window = [Math.min(from, to - least), to];
    this.fill();
  }
  // A chart that was moved takes the others along.
  follow(graph) {
    if (this.filling || this.waits || !this.charts) return;
    const [from, to] = graph.xAxisRange();
    if (from === this.window[0] && to === this.window[1]) return;
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.zoom(from, to), 60);
  }

  fill() {
    this.waits = false;
    const series = this.charts.flatMap(chart => chart.series);
    const rows = this.motion.rows?.(series, ...this.window) ?? chartRows(this.motion, series, ...this.window, this.axis);
    const others = this.other ? chartRows(this.other, series, ...this.window, this.axis) : [];
    this.filling = true;
    let first = 1;
    for (const chart of this.charts) {
      const end = first + chart.series.length, none = chart.series.map(() => null);
      let file = rows.map(row => [row[0], ...row.slice(first, end)]);
      if (this.other)
        file = [...file.map(row => [...row, ...none]), ...others.map(row => [row[0], ...none, ...row.slice(first, end)])]
          .sort((a, b) => a[0] - b[0]);
      chart.graph.updateOptions({file, dateWindow: [...this.window], valueRange: this.rangeOf(chart, file)});
      first = end;
    }
    this.filling = false;
    this.put(this.state);
  }
  // With the limits in it.
  rangeOf(chart, rows) {
    let most = 0, least = 0;
    for (const row of rows)
      for (let k = 1; k < row.length; ++k) if (isFinite(row[k])) {
        most = Math.max(most, row[k]);
        least = Math.min(least, row[k]);
      }
    if (least > -1e-9 * most) least = 0;  // rounding
    for (const one of chart.series) {
      most = Math.max(most, one.limit ?? 0);
      if (least < 0) least = Math.min(least, -(one.limit ?? 0));
    }
    const margin = 0.05 * (most - least) || 1;
    return [least < 0 ? least - margin : 0, most + margin];
  }

  // Puts the cursor where a state is.
  put(state) {
    if (!this.charts) return;
    this.state = {...state, velocity: [...state.velocity], acceleration: [...state.acceleration], jerk: [...state.jerk]};
    for (const chart of this.charts) {
      const x = chart.graph.toDomXCoord(this.axis.of(state)), area = chart.graph.getArea();
      chart.cursor.hidden = !(x >= area.x - 1 && x <= area.x + area.w + 1);
      chart.cursor.style.left = `${x - 1}px`;
      this.tell(chart, state);
    }
  }
  // Fits the pictures to the room that they have.
  fit() {
    for (const chart of this.charts ?? []) chart.graph.resize();
  }
  resize() {
    this.fillIfWaiting();
    this.fit();
  }
  tell(chart, state) {
    chart.heading.replaceChildren(chart.title, ...chart.series.map((one, k) => {
      const entry = document.createElement('span');
      entry.style.color = chart.colors[k];
      entry.textContent = `   ${one.name} ${shortNumber(one.value(state, this.motion))}`;
      return entry;
    }));
  }
}
