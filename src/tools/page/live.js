// A program that runs while the page is open: set points come in, requests go out.

// The last set points, as charts ask for them.
class LiveMotion {
  constructor(axes, limits, channels) {
    Object.assign(this, {axes, limits, channels, states: [], deviates: false, count: 1});
  }
  get duration() { return this.states.at(-1)?.time ?? 0; }
  at() { return this.states.at(-1) ?? this.state([0, 0, 0, 0, 0, 0, 0, 0, 0]); }
  // Of a row: time, line, s, v, a, j; X, Y, Z of the tool; position, velocity, acceleration, jerk of each axis.
  state([time, line, s, v, a, j, ...rest]) {
    const vector = () => new Float64Array(this.channels);
    const state = {time, line, s, v, a, j, tool: rest.slice(0, 3), velocity: vector(), acceleration: vector(), jerk: vector()};
    this.axes.forEach((axis, i) => {
      [state.velocity[axis.channel], state.acceleration[axis.channel], state.jerk[axis.channel]] = rest.slice(4 + 4 * i);
    });
    return state;
  }
  add(rows, seconds) {
    for (const row of rows) this.states.push(this.state(row));
    const oldest = this.duration - seconds;
    let old = 0;
    while (old < this.states.length && this.states[old].time < oldest) ++old;
    this.states.splice(0, old);
  }
  rows(series, from, to) {
    const columns = new Columns(from, to, series.length);
    for (const state of this.states)
      if (state.time >= from && state.time <= to) columns.put(state.time, series.map(one => one.value(state, this)));
    const rows = columns.rows();
    return rows.length > 0 ? rows : [[from, ...series.map(() => 0)]];
  }
}

class Live {
  // `follow(t, tool)`: called with the time of the plan at which the path is as long as now.
  constructor(element, report, plan, follow) {
    Object.assign(this, {element, plan, follow, next: 0, run: 0, drawn: 0, seconds: 20, state: ''});
    this.find = id => document.getElementById(`live-${id}`);
    element.hidden = this.find('section').hidden = false;
    this.motion = new LiveMotion(plan.axes, plan.limits, plan.channels);
    this.motion.velocityLimit = plan.velocityLimit;
    this.charts = new Charts(this.find('charts'), []);
    this.charts.show(this.motion);
    for (const button of element.querySelectorAll('[data-ask]'))
      button.addEventListener('click', () => this.ask(button.dataset.ask));
    for (const name of ['feed', 'rapid'])
      this.find(name).addEventListener('input', event => this.ask(name, event.target.value / 100));
    this.find('step').addEventListener('change', event => this.ask('step', event.target.checked ? 1 : 0));
    this.poll();
  }

  ask(name, value = '') {
    return fetch(`ask/${name}?value=${value}`, {method: 'POST'}).catch(() => this.tell('not connected', true));
  }
  toggle() { this.ask(this.state === 'moves' ? 'hold' : 'resume'); }
  tell(text, bad) {
    this.find('state').textContent = text;
    this.find('state').classList.toggle('error', bad);
  }

  async poll() {
    for (;;) {
      let wait = 40;  // ms
      try {
        this.take(await (await fetch(`rows?after=${this.next}`)).json());
      } catch (error) {
        this.tell(`not connected: ${error.message}`, true);
        wait = 1000;
      }
      await new Promise(done => setTimeout(done, wait));
    }
  }
  take(answer) {
    this.next = answer.next;
    this.state = answer.state;
    if (answer.run !== this.run) {  // from the start again
      this.run = answer.run;
      this.motion.states.length = 0;
    }
    this.motion.add(answer.rows, this.seconds);
    const now = this.motion.at();
    this.tell(answer.error || `${answer.state}, ${now.time.toFixed(3)} s, line ${now.line}, ${shortNumber(now.v)} mm/s`, answer.error !== '');
    for (const name of ['feed', 'rapid']) {
      const input = this.find(name);
      if (document.activeElement !== input) input.value = 100 * answer[name];
      input.nextElementSibling.textContent = `${Math.round(100 * answer[name])} %`;
    }
    this.find('step').checked = answer.step;
    if (answer.rows.length === 0 || performance.now() - this.drawn < 100) return;
    this.drawn = performance.now();
    this.charts.window = this.charts.all = [Math.max(now.time - this.seconds, 0), Math.max(now.time, 1)];
    this.charts.state = now;
    this.charts.fill();
    if (this.find('follow').checked) this.follow(this.plan.timeAtLength(now.s), now.tool);
  }
}
