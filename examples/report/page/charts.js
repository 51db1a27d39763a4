// What happens over time: charts that share the time and the cursor.

const seriesColors = ['#0072b2', '#d55e00', '#009e73', '#cc79a7', '#e69f00', '#56b4e9', '#666666', '#000000', '#8c6d1f'];

// A chart is a title and series, each with a name, a value of a state, and a limit if there is one.
function chartsOf(motion) {
  const limit = x => (isFinite(x ?? Infinity) ? x : undefined);
  const perAxis = (what, order) => motion.axes.map(axis => ({
    name: axis.name, value: s => s[what][axis.channel], limit: limit(axis.limits[order])}));
  const along = (value, order) => ({name: 'along the path', value, limit: limit(motion.limits[order])});
  const unit = motion.axes.some(axis => axis.unit === 'deg') ? 'mm or degrees' : 'mm';
  return [
    {title: 'speed along the path, mm/s', series: [
      {name: 'speed', value: s => s.v, limit: limit(motion.limits[0])},
      {name: 'programmed', value: (s, m) => { const w = m.block.wanted[s.block]; return isFinite(w) ? w : NaN; }}]},
    {title: `velocity, ${unit}/s`, series: perAxis('velocity', 0)},
    {title: `acceleration, ${unit}/s²`, series: [...perAxis('acceleration', 1), along(s => s.a, 1)]},
    {title: `jerk, ${unit}/s³`, series: [...perAxis('jerk', 2), along(s => s.j, 2)]},
    {title: 'step rate, 1/s', series: motion.axes.map(axis => ({
      name: axis.name, value: s => Math.abs(s.velocity[axis.channel]) * axis.stepsPerUnit}))},
  ];
}

// Rows of time and values within a window. Where it holds more than can be drawn, each column of the picture has
// its smallest and its largest value.
function chartRows(motion, series, from, to) {
  const columns = 1000, room = motion.room(), first = motion.phaseAt(from), last = motion.phaseAt(to);
  const whole = 4 * (last - first + 1) <= 3 * columns, width = (to - from) / columns;
  const rows = [], low = [], high = [];
  const put = (t, state) => {
    const values = series.map(one => one.value(state, motion));
    if (whole) return rows.push([t, ...values]);
    const column = Math.min(Math.max(Math.floor((t - from) / width), 0), columns - 1);
    low[column] = low[column]?.map((x, k) => Math.min(x, values[k])) ?? values;
    high[column] = high[column]?.map((x, k) => Math.max(x, values[k])) ?? values;
  };
  for (let i = first; i <= last && i < motion.count; ++i) {
    const start = Math.max(motion.phase.time[i], from), end = Math.min(motion.phase.time[i] + motion.durationOf(i), to);
    const parts = Math.max(whole ? 4 : 1, Math.ceil((end - start) / width));
    for (let k = 0; k <= parts; ++k) {
      const t = k === parts ? end : start + (end - start) * k / parts;
      put(t, motion.inPhase(i, t, room));
    }
  }
  for (let column = 0; column < low.length; ++column) {
    if (!low[column]) continue;
    rows.push([from + column * width, ...low[column]], [from + (column + 0.5) * width, ...high[column]]);
  }
  return rows.length > 0 ? rows : [[0, ...series.map(() => 0)]];
}

class Charts {
  constructor(element, marks) {
    this.element = element;
    this.marks = marks;
    this.hovered = () => {};
    this.time = 0;
  }

  show(motion) {
    this.motion = motion;
    this.element.replaceChildren();
    this.window = this.all = [0, motion.duration > 0 ? motion.duration : 1];
    this.charts = chartsOf(motion).map(chart => this.add(chart));
    this.fill();
  }

  add(chart) {
    const box = document.createElement('div'), heading = document.createElement('h3'), plot = document.createElement('div');
    const cursor = document.createElement('div');
    box.className = 'chart';
    plot.className = 'plot';
    cursor.className = 'cursor';
    box.append(heading, plot);
    this.element.append(box);
    const colors = chart.series.map((_, k) => seriesColors[k % seriesColors.length]);
    const zeros = chart.series.map(() => 0);
    const graph = new Dygraph(plot, [[0, ...zeros], [1, ...zeros]], {
      labels: ['t', ...chart.series.map(one => one.name)], colors, strokeWidth: 1.5, legend: 'never', animatedZooms: false,
      axisLabelFontSize: 13, highlightCircleSize: 0, axes: {y: {axisLabelWidth: 70, pixelsPerLabel: 22}},
      underlayCallback: (context, area, g) => this.underlay(context, area, g, chart, colors),
      zoomCallback: (from, to) => this.zoom(from, to),
      drawCallback: g => this.follow(g),
    });
    plot.append(cursor);
    plot.addEventListener('mousemove', event => {
      if (event.buttons !== 0) return;
      const t = graph.toDataXCoord(event.clientX - plot.getBoundingClientRect().left);
      if (t >= 0 && t <= this.motion.duration) this.hovered(t);
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
    context.strokeStyle = context.fillStyle = '#444';
    context.font = '12px sans-serif';
    for (const mark of this.marks) {
      const x = graph.toDomXCoord(mark.time);
      context.strokeRect(x, area.y, 0, area.h);
      context.fillText(mark.text, x + 3, area.y + 11);
    }
    context.restore();
  }

  zoomAbout(t, factor) {
    const [from, to] = this.window;
    this.zoom(t - (t - from) * factor, t + (to - t) * factor);
  }
  zoom(from, to) {
    const least = 1e-6;
    from = Math.max(from, this.all[0]);
    to = Math.min(Math.max(to, from + least), this.all[1]);
    this.window = [Math.min(from, to - least), to];
    this.fill();
  }
  // A chart that was moved takes the others along.
  follow(graph) {
    if (this.filling || !this.charts) return;
    const [from, to] = graph.xAxisRange();
    if (from === this.window[0] && to === this.window[1]) return;
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.zoom(from, to), 60);
  }

  fill() {
    const series = this.charts.flatMap(chart => chart.series);
    const rows = chartRows(this.motion, series, ...this.window);
    this.filling = true;
    let first = 1;
    for (const chart of this.charts) {
      const end = first + chart.series.length;
      const file = rows.map(row => [row[0], ...row.slice(first, end)]);
      chart.graph.updateOptions({file, dateWindow: [...this.window], valueRange: this.rangeOf(chart, file)});
      first = end;
    }
    this.filling = false;
    this.put(this.time);
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

  // Puts the cursor at an instant; `state`, if given, is what the titles tell.
  put(t, state) {
    this.time = t;
    for (const chart of this.charts) {
      const x = chart.graph.toDomXCoord(t), area = chart.graph.getArea();
      chart.cursor.hidden = !(x >= area.x - 1 && x <= area.x + area.w + 1);
      chart.cursor.style.left = `${x - 1}px`;
      if (state) this.tell(chart, state);
    }
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
