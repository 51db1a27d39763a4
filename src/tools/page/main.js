// Puts the page together. Every change of the cursor goes through `setTime`.

const cncplan = (() => {
  const dark = matchMedia('(prefers-color-scheme: dark)');
  setTheme(dark.matches);
  const byId = id => document.getElementById(id);
  const report = JSON.parse(byId('data').textContent);
  const lines = report.text.split('\n').slice(0, report.keptLines);
  const motions = report.plans.map(plan => motionOf(plan, report.axes, report.limits));
  const modes = colorModes(report.limitedByNames).filter(one => one.name !== 'deviation' || motions.some(m => m.deviates));
  const charts = new Charts(byId('charts'), report.marks);
  const program = new ProgramText(byId('program'), lines);
  let motion = motions[0], view = null, time = 0, mode = modes[0], room = motion.room();

  function note(id, text) { byId(id).append(element('p', {textContent: text})); }
  try {
    view = new View(byId('view'), report.drawings);
  } catch (error) {  // without WebGL
    note('notes', `There is no view in space: ${error.message}`);
  }

  function setTime(t) {
    const state = motion.at(t, room);
    time = state.time;
    view?.put(state);
    charts.put(state);
    program.mark(motion.lineOf(state));
    showState(report, motion, state);
    byId('slider').value = time;
    if (document.activeElement !== byId('time')) byId('time').value = Number(time.toFixed(6));
  }
  function goToLine(line) {
    const start = motion.startOfLine(line);
    setTime(start ?? motion.duration);
  }
  function setMode(index) {
    mode = modes[index];
    byId('color').selectedIndex = index;
    showLegend(mode, view?.color(mode) ?? 0);
  }
  function showMotion(index) {
    motion = motions[index];
    room = motion.room();
    const sums = sweep(motion, lines.length, report.limitedByNames.length);
    byId('slider').max = motion.duration;
    const other = motions.length > 1 ? motions[(index + 1) % motions.length] : null;
    byId('plan').selectedIndex = index;
    byId('magnify-label').hidden = !motion.deviates;
    view?.show(motion, other);
    charts.show(motion, other);
    program.show(sums.byLine);
    showSummary(report, motion);
    showFigures(report, motion, motions, sums);
    showPeaks(report, motions[0]);
    showLimited(report, motion, sums);
    showCostliest(lines, sums, motion, goToLine);
    showHistogram(sums);
    setMode(modes.indexOf(mode));
    setTime(Math.min(time, motion.duration));
  }
  function putTheme(isDark) {
    if (theme.dark === isDark) return;
    setTheme(isDark);
    charts.show(charts.motion, charts.other);
    showLimited(report, motion, sweep(motion, lines.length, report.limitedByNames.length));
    setMode(modes.indexOf(mode));
    setTime(time);
  }
  dark.addEventListener('change', () => putTheme(dark.matches));
  // The motion before or behind that of the cursor.
  function stepMotion(by) {
    const line = motion.lineOf(motion.at(time, room));
    if (by > 0) return goToLine(line + 1);
    let i = motion.phaseAt(time);
    while (i > 0 && motion.block.line[motion.phase.block[i]] >= line) --i;
    goToLine(motion.block.line[motion.phase.block[i]]);
  }

  const player = new Player(byId('play'), byId('rate'), () => motion.duration, () => time, setTime);
  charts.hovered = t => { if (!player.playing) setTime(t); };
  program.chosen = goToLine;
  if (view) view.picked = setTime;
  byId('slider').addEventListener('input', event => setTime(Number(event.target.value)));
  byId('time').addEventListener('change', event => setTime(Number(event.target.value)));
  byId('color').append(...modes.map(one => element('option', {textContent: one.name})));
  byId('color').addEventListener('change', event => setMode(event.target.selectedIndex));
  byId('help-button').addEventListener('click', () => { byId('help').hidden = !byId('help').hidden; });
  byId('fit').addEventListener('click', () => view?.orbit.fit(view.box));
  for (const button of document.querySelectorAll('[data-view]'))
    button.addEventListener('click', () => view?.orbit.look(button.dataset.view));
  byId('plan-label').hidden = motions.length < 2;
  byId('plan').append(...motions.map(one => element('option', {textContent: one.name})));
  byId('plan').addEventListener('change', event => showMotion(event.target.selectedIndex));
  byId('magnify').addEventListener('change', event => view?.magnify(Number(event.target.value)));
  byId('over').addEventListener('change', event => {
    charts.axis = chartAxes[event.target.value];
    charts.show(charts.motion, charts.other);
  });
  function chooseNext(id) {
    const select = byId(id);
    if (select.parentElement.hidden) return;
    select.selectedIndex = (select.selectedIndex + 1) % select.length;
    select.dispatchEvent(new Event('change'));
  }

  // On paper, pictures are as wide as the page, on white, and nothing is folded.
  const folded = [...document.querySelectorAll('details:not(#licences)')];
  function fitPaper(printing) {
    document.documentElement.classList.toggle('paper', printing);
    for (const part of folded) {
      if (printing) part.dataset.open = part.open;
      part.open = printing || part.dataset.open === 'true';
    }
    putTheme(dark.matches && !printing);
    charts.resize();
    view?.resize();
    view?.draw();
  }
  addEventListener('beforeprint', () => fitPaper(true));
  addEventListener('afterprint', () => fitPaper(false));

  const views = [...document.querySelectorAll('[data-view]')];
  const keys = {
    ' ': () => (live ? live.toggle() : player.toggle()),
    ArrowRight: event => setTime(time + (event.shiftKey ? 0.1 : 0.001)),
    ArrowLeft: event => setTime(time - (event.shiftKey ? 0.1 : 0.001)),
    ArrowDown: () => stepMotion(1),
    ArrowUp: () => stepMotion(-1),
    Home: () => setTime(0),
    End: () => setTime(motion.duration),
    f: () => byId('fit').click(),
    c: () => setMode((modes.indexOf(mode) + 1) % modes.length),
    l: () => chooseNext('over'),
    m: () => chooseNext('magnify'),
    p: () => chooseNext('plan'),
    '+': () => charts.zoomAtCursor(0.5),
    '-': () => charts.zoomAtCursor(2),
    0: () => charts.zoom(...charts.all),
    '?': () => byId('help-button').click(),
  };
  document.addEventListener('keydown', event => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.target.closest('input, select')) return;
    if (event.key === ' ' && event.target.closest('button, summary')) return;  // which it presses
    const act = keys[event.key] ?? keys[event.key.toLowerCase()];
    if (act) act(event);
    else if (views[event.key - 1]) views[event.key - 1].click();
    else return;
    event.preventDefault();
  });

  for (const text of report.warnings) note('warnings', text);
  byId('warnings').hidden = report.warnings.length === 0;
  byId('warnings').firstElementChild.textContent = report.warnings.length === 1 ? '1 warning' : `${report.warnings.length} warnings`;
  if (report.keptLines < report.lines)
    note('notes', `The program has ${report.lines} lines; the text is that of the first ${report.keptLines}.`);
  if (motion instanceof SampledMotion)
    note('notes', `The motion is too long to be kept whole: it is kept at instants ${shortNumber(motion.period)} s apart. ` +
         `Between them positions are up to ${shortNumber(motion.gap)} mm (or degrees) off, and values change evenly.`);
  if (motion.count === 0 || !(motion.duration > 0)) note('notes', 'Nothing moves.');
  showPlans(motions);
  const live = report.live ? new Live(byId('live'), report, motions[0], (t, tool) => {
    setTime(t);
    view?.putTool(tool);
  }) : null;
  showMotion(0);
  return {live, report, lines, motions, view, charts, program, player, setTime, goToLine, setMode,
          state: () => motion.at(time), time: () => time};
})();
