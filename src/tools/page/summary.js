// Tables and the histogram: what the run comes to.

function shortNumber(x) {
  if (!isFinite(x)) return '';
  return Math.abs(x) >= 1e5 || (x !== 0 && Math.abs(x) < 1e-3) ? x.toExponential(2) : String(Number(x.toPrecision(5)));
}
function timeText(seconds) {
  const whole = Math.floor(seconds), hours = Math.floor(whole / 3600), minutes = Math.floor(whole / 60) % 60;
  if (seconds < 60) return `${seconds.toFixed(3)} s`;
  return `${hours > 0 ? `${hours} h ` : ''}${minutes} min ${(seconds - 60 * Math.floor(whole / 60)).toFixed(1)} s`;
}

// Replaces a table's rows. A cell is text, or an element; numbers are right-aligned.
function fillTable(table, rows, headings) {
  const row = (cells, tag) => {
    const tr = document.createElement('tr');
    for (const content of cells) {
      const cell = document.createElement(tag);
      cell.append(typeof content === 'number' ? shortNumber(content) : content);
      if (typeof content === 'number') {
        cell.className = 'number';
        cell.dataset.value = content;
      }
      tr.append(cell);
    }
    return tr;
  };
  table.replaceChildren(...(headings ? [row(headings, 'th')] : []), ...rows.map(cells => row(cells, 'td')));
}
function element(tag, properties) { return Object.assign(document.createElement(tag), properties); }
function bar(share) {
  const result = element('span', {className: 'bar'});
  result.style.width = `${(10 * share).toFixed(3)}rem`;
  return result;
}

function showSummary(report, motion) {
  const rows = [...report.summary,
                ['mean speed', `${shortNumber(motion.duration > 0 ? motion.length / motion.duration : 0)} mm/s`],
                ['in this file', motion.kept]];
  fillTable(document.getElementById('summary'), rows);
}

function showLimited(report, motion, sums) {
  const rows = report.limitedByNames.map((name, k) => [k, name, sums.byLimit[k]])
    .filter(([, , seconds]) => seconds > 0).sort((a, b) => b[2] - a[2])
    .map(([k, name, seconds]) => {
      const label = element('span'), swatch = element('span', {className: 'swatch'});
      swatch.style.background = cssColor(distinctColor(k));
      label.append(swatch, name);
      const share = seconds / motion.duration;
      return [label, timeText(seconds), `${(100 * share).toFixed(1)} %`, bar(share)];
    });
  fillTable(document.getElementById('limited'), rows);
}

// Beyond a limit by more than rounding.
const beyond = share => share > 1.00005;

// The largest values of the tool and of each axis: name, unit, and for velocity, acceleration and jerk one or more
// {value, limit, of}. Rapids have a limit of their own.
function peakRows(report, motion) {
  const {cutting, rapid, rate} = motion.speeds, of = (peaks, limits) => peaks.map((value, k) => [{value, limit: limits[k] ?? Infinity, of: ''}]);
  const tool = of(report.toolPeak, report.limits);
  if (rapid > (report.limits[0] ?? Infinity))
    tool[0] = [{value: cutting, limit: report.limits[0], of: ' cutting'}, {value: Math.max(rapid, report.toolPeak[0]), limit: rate, of: ' rapid'}];
  return [{name: 'tool', unit: 'mm', peaks: tool},
          ...report.axes.map(axis => ({name: axis.name, unit: axis.unit, peaks: of(axis.peak, axis.limits)}))];
}
function showPeaks(report, motion) {
  const cell = one => {
    const text = isFinite(one.limit) ? `${shortNumber(one.value)} of ${shortNumber(one.limit)} (${(100 * one.value / one.limit).toFixed(2)} %)` : shortNumber(one.value);
    return element('div', {textContent: text + one.of, className: beyond(one.value / one.limit) ? 'over' : ''});
  };
  fillTable(document.getElementById('peaks'), peakRows(report, motion).map(({name, unit, peaks}) => [`${name}, ${unit}`, ...peaks.map(
    list => { const all = element('span'); all.append(...list.map(cell)); return all; })]), ['', 'velocity', 'acceleration', 'jerk']);
}

// What one asks first, large.
function showFigures(report, motion, motions, sums) {
  const figures = [], add = (value, name, bad) => figures.push([value, name, bad]);
  const other = motions.find(one => one !== motion);
  add(timeText(motion.duration), other ? `${motion.name}; ${other.name}: ${timeText(other.duration)}` : 'time');
  add(`${shortNumber(Number(motion.length.toPrecision(4)))} mm`, 'path');
  if (motion.duration > 0) add(`${shortNumber(Number((motion.length / motion.duration).toPrecision(3)))} mm/s`, 'mean speed');
  if (motion.deviates)
    add(`${shortNumber(Number(motion.largestDeviation.toPrecision(3)))} mm`, `off the path${motion.tolerance ? `, of ${shortNumber(motion.tolerance)} allowed` : ''}`);
  let most = {share: 0};
  for (const [k, what] of [[2, 'jerk'], [1, 'acceleration'], [0, 'velocity']])
    for (const {name, peaks} of peakRows(report, motion))
      for (const {value, limit} of peaks[k])
        if (value / limit > most.share * 1.0001) most = {share: value / limit, text: `${name === 'tool' ? "the tool's" : `${name}'s`} ${what}`};
  if (most.text && motion === motions[0]) add(`${(100 * most.share).toFixed(1)} %`, `of a limit at most: ${most.text}`, beyond(most.share));
  const first = sums.byLimit.indexOf(Math.max(...sums.byLimit));
  if (motion.duration > 0) add(`${(100 * sums.byLimit[first] / motion.duration).toFixed(0)} %`, `of the time limited by: ${report.limitedByNames[first]}`);
  document.getElementById('figures').replaceChildren(...figures.map(([value, name, bad]) => {
    const figure = element('div');
    figure.append(element('b', {textContent: value, className: bad ? 'over' : ''}), element('span', {textContent: name}));
    return figure;
  }));
}

// Plans of one program beside each other, if there are several.
function showPlans(motions) {
  document.getElementById('plans-section').hidden = motions.length < 2;
  const first = motions[0].duration;
  fillTable(document.getElementById('plans'), motions.map(motion => [
    motion.name, timeText(motion.duration), first > 0 ? `${(100 * motion.duration / first).toFixed(2)} %` : '',
    `${shortNumber(motion.duration > 0 ? motion.length / motion.duration : 0)} mm/s`, `${shortNumber(motion.largestDeviation)} mm`]),
            ['plan', 'time', 'of the first', 'mean speed', 'largest deviation']);
}

function showCostliest(lines, sums, motion, choose) {
  const order = [...sums.byLine.keys()].filter(line => sums.byLine[line] > 0)
    .sort((a, b) => sums.byLine[b] - sums.byLine[a]).slice(0, 100);
  const table = document.getElementById('costliest');
  fillTable(table, order.map(line => {
    const seconds = sums.byLine[line];
    return [String(line), `${seconds.toFixed(4)} s`, `${(100 * seconds / motion.duration).toFixed(2)} %`, bar(seconds / sums.byLine[order[0]]),
            `${shortNumber(sums.lengthByLine[line] / seconds)} mm/s`, lines[line - 1] ?? ''];
  }), ['line', 'time', 'share', '', 'mean speed', '']);
  order.forEach((line, k) => {
    const row = table.rows[k + 1];
    row.dataset.line = line;
    row.tabIndex = 0;
    row.addEventListener('click', () => choose(line));
    row.addEventListener('keydown', event => { if (event.key === 'Enter') choose(line); });
  });
}

function showHistogram(sums) {
  const width = 460, height = 170, left = 44, bottom = 24, n = sums.bySpeed.length;
  const most = sums.bySpeed.reduce((a, b) => Math.max(a, b), 0) || 1, step = (width - left) / n;
  const bars = [...sums.bySpeed].map((seconds, k) => {
    const h = (height - bottom - 12) * seconds / most;
    const range = `${shortNumber(sums.top * k / n)} to ${shortNumber(sums.top * (k + 1) / n)} mm/s: ${timeText(seconds)}`;
    return `<rect x="${left + k * step}" y="${height - bottom - h}" width="${step * 0.9}" height="${h}"><title>${range}</title></rect>`;
  });
  document.getElementById('histogram').innerHTML =
    `<svg width="${width}" height="${height}" role="img" aria-label="time at each speed" font-size="13">${bars.join('')}
     <line x1="${left}" x2="${width}" y1="${height - bottom}" y2="${height - bottom}" stroke="currentColor"/>
     <text x="${left}" y="${height - 7}">0</text><text x="${width}" y="${height - 7}" text-anchor="end">${shortNumber(sums.top)} mm/s</text>
     <text x="0" y="12">${shortNumber(most)} s</text></svg>`;
}

function showLegend(mode, top) {
  const legend = document.getElementById('legend'), title = element('div', {textContent: mode.unit ? `${mode.name}, ${mode.unit}` : mode.name});
  if (mode.names) {
    legend.replaceChildren(title, ...mode.names.map((name, k) => {
      const entry = element('div'), swatch = element('span', {className: 'swatch'});
      swatch.style.background = cssColor(distinctColor(mode.colors?.[k] ?? k));
      entry.append(swatch, name);
      return entry;
    }));
    return;
  }
  const canvas = element('canvas', {width: 1, height: 256}), context = canvas.getContext('2d');
  for (let y = 0; y < 256; ++y) {
    context.fillStyle = cssColor(scaleColor(1 - y / 255));
    context.fillRect(0, y, 1, 1);
  }
  const scale = element('div', {className: 'scale'}), ends = element('div', {className: 'ends'});
  ends.append(...[1, 0.75, 0.5, 0.25, 0].map(part => element('span', {textContent: shortNumber(Number((part * top).toPrecision(3)))})));
  scale.append(canvas, ends);
  legend.replaceChildren(title, scale);
}

// Values at the cursor. Each has its full number in data-value.
function showState(report, motion, state) {
  const table = document.getElementById('state'), [x, y, z] = motion.programmed(state);
  const cells = [['t, s', state.time], ['line', motion.lineOf(state)], ['X', x], ['Y', y], ['Z', z], ['s, mm', state.s],
                 ['v, mm/s', state.v], ['a, mm/s²', state.a], ['j, mm/s³', state.j]];
  const of = (axis, name, vector) => cells.push([`${axis.name} ${name}`, vector[axis.channel]]);
  for (const axis of report.axes) {
    if (axis.channel > 2) cells.push([`axis ${axis.name}, ${axis.unit}`, state.position[axis.channel]]);
    of(axis, 'velocity', state.velocity);
    of(axis, 'acceleration', state.acceleration);
    of(axis, 'jerk', state.jerk);
  }
  const why = report.limitedByNames[motion.phase.limitedBy[state.phase] ?? 0];
  const columns = 9, rows = [];
  for (let k = 0; k < cells.length; k += columns) {
    const part = cells.slice(k, k + columns);
    rows.push(part.map(([name]) => element('span', {textContent: name, className: 'name'})), part.map(([, value]) => value));
  }
  fillTable(table, [...rows, ['limited by', why]]);
}
