// Colours of the path: a scale from dark to light that the colour-blind read as well (viridis), and distinct
// colours for kinds (Okabe and Ito). What does not show on the ground, white or nearly black, is left out or replaced.

const theme = {
  dark: false,
  get ground() { return this.dark ? 0x17191c : 0xffffff; },
  get ink() { return this.dark ? '#fff' : '#000'; },
  get faint() { return this.dark ? '#a0a4a8' : '#444'; },
  get grid() { return this.dark ? '#33373c' : '#ddd'; },
};

const scaleStops = [[68, 1, 84], [72, 40, 120], [62, 74, 137], [49, 104, 142], [38, 130, 142], [31, 158, 137],
                    [53, 183, 121], [109, 205, 89], [180, 222, 44], [253, 231, 37]];
const distinct = [[153, 153, 153], [0, 114, 178], [86, 180, 233], [0, 158, 115], [230, 159, 0], [213, 94, 0],
                  [204, 121, 167], [60, 60, 60], [240, 228, 66]];

const darkDistinct = {0: [130, 130, 130], 1: [60, 150, 220], 7: [235, 235, 235]};

// r, g, b from 0 to 1; x from 0 to 1.
function scaleColor(x) {
  const share = Math.min(Math.max(x, 0), 1), last = scaleStops.length - 1;
  const at = theme.dark ? 2.4 + share * (last - 2.4 - 1e-9) : share * (last - 2.4);
  const i = Math.floor(at), part = at - i;
  return scaleStops[i].map((c, k) => (c + part * (scaleStops[i + 1][k] - c)) / 255);
}
function distinctColor(index) {
  const k = index % distinct.length;
  return ((theme.dark && darkDistinct[k]) || distinct[k]).map(c => c / 255);
}
function cssColor(rgb) { return `rgb(${rgb.map(c => Math.round(255 * c)).join(',')})`; }
// For many places colours are taken from tables, r, g and b in bytes.
const scaleSteps = 1000, inBytes = colors => new Uint8Array(colors.flat().map(c => Math.round(255 * c)));
let scaleTable, distinctTable;
function setTheme(dark) {
  theme.dark = dark;
  scaleTable = inBytes(Array.from({length: scaleSteps + 1}, (_, i) => scaleColor(i / scaleSteps)));
  distinctTable = inBytes(distinct.map((_, i) => distinctColor(i)));
}

const kindNames = ['rapid', 'line', 'arc'];

// Each way to colour: a value at a state, from 0 to `top(motion)` or to the largest that is there; or a kind. `along`: the
// motion along the path tells it.
function colorModes(limitNames) {
  const limit = k => motion => motion.limits[k];
  return [
    {name: 'speed', unit: 'mm/s', along: true, value: s => s.v},
    {name: 'share of limit', unit: '', value: (s, m) => m.share(s), top: () => 1},
    {name: 'acceleration', unit: 'mm/s²', value: (s, m) => m.ofTool(s, s.acceleration), top: limit(1)},
    {name: 'jerk', unit: 'mm/s³', value: (s, m) => m.ofTool(s, s.jerk), top: limit(2)},
    {name: 'curvature', unit: '1/mm', value: s => norm(s.second)},
    {name: 'speed against programmed feed', unit: '', along: true,
     value: (s, m) => { const w = m.wanted(s); return w > 0 ? s.v / w : 1; }, top: () => 1},
    {name: 'deviation', unit: 'mm', along: true, value: (s, m) => m.deviation(s)},
    {name: 'what limits the speed', along: true, names: limitNames, kind: (s, m) => m.phase.limitedBy[s.phase] ?? 0},
    {name: 'rapid, line, arc', along: true, names: kindNames, kind: (s, m) => [5, 1, 3][m.kindOf(s)], colors: [5, 1, 3]},
  ];
}
