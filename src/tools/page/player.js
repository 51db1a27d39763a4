// Plays the time: as fast as it runs, slower or faster.

class Player {
  constructor(button, rate, duration, at, set) {
    Object.assign(this, {button, rate, duration, at, set, last: null});
    button.addEventListener('click', () => this.toggle());
  }
  get playing() { return this.last !== null; }
  toggle() { if (this.playing) this.pause(); else this.play(); }
  play() {
    if (this.at() >= this.duration()) this.set(0);
    this.last = performance.now();
    this.button.textContent = 'Pause';
    requestAnimationFrame(now => this.tick(now));
  }
  pause() {
    this.last = null;
    this.button.textContent = 'Play';
  }
  tick(now) {
    if (!this.playing) return;
    const seconds = Math.max(now - this.last, 0) / 1000 * Number(this.rate.value);
    this.last = now;
    this.set(Math.min(this.at() + seconds, this.duration()));
    if (this.at() >= this.duration()) return this.pause();
    requestAnimationFrame(next => this.tick(next));
  }
}
