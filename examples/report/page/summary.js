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

function showPeaks(report) {
  const table = document.getElementById('peaks'), over = 1.00005;
  const row = (name, unit, peaks, limits) => [`${name}, ${unit}`, ...peaks.map((peak, order) => {
    const limit = limits[order];
    const text = limit ? `${shortNumber(peak)} of ${shortNumber(limit)} (${(100 * peak / limit).toFixed(2)} %)` : shortNumber(peak);
    return element('span', {textContent: text, className: limit && peak > over * limit ? 'over' : ''});
  })];
  fillTable(table, [row('tool', 'mm', report.toolPeak, report.limits),
                    ...report.axes.map(axis => row(axis.name, axis.unit, axis.peak, axis.limits))],
            ['', 'velocity', 'acceleration', 'jerk']);
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
    return `<rect x="${left + k * step}" y="${height - bottom - h}" width="${step * 0.9}" height="${h}" fill="#0072b2"><title>${range}</title></rect>`;
  });
  document.getElementById('histogram').innerHTML =
    `<svg width="${width}" height="${height}" role="img" aria-label="time at each speed" font-size="13">${bars.join('')}
     <line x1="${left}" x2="${width}" y1="${height - bottom}" y2="${height - bottom}" stroke="#666"/>
     <text x="${left}" y="${height - 7}">0</text><text x="${width}" y="${height - 7}" text-anchor="end">${shortNumber(sums.top)} mm/s</text>
     <text x="0" y="12">${shortNumber(most)} s</text></svg>`;
}

function showLegend(mode, top) {
  const legend = document.getElementById('legend');
  if (mode.names) {
    legend.replaceChildren(`${mode.name}: `, ...mode.names.map((name, k) => {
      const entry = element('span'), swatch = element('span', {className: 'swatch'});
      swatch.style.background = cssColor(distinctColor(mode.colors?.[k] ?? k));
      entry.append(swatch, name);
      return entry;
    }));
    return;
  }
  const canvas = element('canvas', {width: 256, height: 1}), context = canvas.getContext('2d');
  for (let x = 0; x < 256; ++x) {
    context.fillStyle = cssColor(scaleColor(x / 255));
    context.fillRect(x, 0, 1, 1);
  }
  legend.replaceChildren(`${mode.name}: 0`, canvas, `${shortNumber(top)} ${mode.unit}`);
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
