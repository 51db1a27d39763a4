// One walk over a motion for all that adds up over time: time by line, by speed, by what limits it.

function sweep(motion, lineCount, limitCount) {
  const byLine = new Float64Array(lineCount + 1), lengthByLine = new Float64Array(lineCount + 1);
  const byLimit = new Float64Array(limitCount);
  let top = 0;
  for (let i = 0; i < motion.count; ++i) top = Math.max(top, motion.phase.v[i]);
  const bins = 40, bySpeed = new Float64Array(bins);
  for (let i = 0; i < motion.count; ++i) {
    const ph = motion.phase, seconds = motion.durationOf(i), line = motion.block.line[ph.block[i]];
    const speedAt = tau => ph.v[i] + tau * (ph.a[i] + tau * ph.j[i] / 2);
    byLimit[ph.limitedBy[i]] += seconds;
    if (line <= lineCount) {
      byLine[line] += seconds;
      lengthByLine[line] += seconds * (ph.v[i] + seconds * (ph.a[i] / 2 + seconds * ph.j[i] / 6));
    }
    const change = seconds * (Math.abs(ph.a[i]) + seconds * Math.abs(ph.j[i]) / 2);  // of the speed, at most
    const parts = change * bins < 0.1 * top ? 1 : 8;
    for (let k = 0; k < parts && top > 0; ++k) {
      const bin = Math.floor(bins * speedAt(seconds * (k + 0.5) / parts) / (top * 1.000001));
      bySpeed[Math.min(Math.max(bin, 0), bins - 1)] += seconds / parts;
    }
  }
  return {byLine, lengthByLine, byLimit, bySpeed, top};
}
