// The program's text beside the view. Only the lines that are seen are there as elements.

class ProgramText {
  constructor(element, lines) {
    this.element = element;
    this.space = element.firstElementChild;
    this.lines = lines;
    this.height = 20;  // px, as the style has it
    this.current = 0;
    this.rows = new Map();  // those that are there, by index
    this.chosen = () => {};
    this.seconds = null;
    this.space.style.height = `${this.height * lines.length}px`;
    this.space.style.width = `${20 + Math.min(300, lines.reduce((most, line) => Math.max(most, line.length), 0))}ch`;
    element.setAttribute('aria-rowcount', lines.length);
    element.addEventListener('scroll', () => this.render());
    element.addEventListener('click', event => {
      const row = event.target.closest('.line');
      if (row) this.chosen(Number(row.dataset.line));
    });
    new ResizeObserver(() => this.render()).observe(element);
  }

  // s of each line, from 1.
  show(seconds) {
    this.seconds = seconds;
    this.space.replaceChildren();
    this.rows.clear();
    this.render();
  }
  mark(line) {
    if (line === this.current) return;
    const before = this.rows.get(this.current - 1);
    this.current = line;
    const top = (line - 1) * this.height, seen = this.element.clientHeight;
    if (line > 0 && (top < this.element.scrollTop || top + this.height > this.element.scrollTop + seen))
      this.element.scrollTop = top - seen / 2;
    this.render();
    for (const row of [before, this.rows.get(line - 1)]) if (row) this.dress(row);
  }

  // Rows that are still seen stay: one that is pressed would not be clicked if another took its place.
  render() {
    const first = Math.max(0, Math.floor(this.element.scrollTop / this.height) - 5);
    const end = Math.min(this.lines.length, first + Math.ceil(this.element.clientHeight / this.height) + 10);
    for (const [i, row] of this.rows) {
      if (i >= first && i < end) continue;
      row.remove();
      this.rows.delete(i);
    }
    let next = this.space.firstChild;
    for (let i = first; i < end; ++i) {
      const row = this.rows.get(i);
      if (row) next = row.nextSibling;
      else this.space.insertBefore(this.rows.set(i, this.row(i)).get(i), next);
    }
  }
  dress(row) {
    const current = Number(row.dataset.line) === this.current;
    row.classList.toggle('current', current);
    row.setAttribute('aria-selected', current);
  }
  row(i) {
    const row = document.createElement('div');
    row.className = 'line';
    row.style.top = `${i * this.height}px`;
    row.dataset.line = i + 1;
    row.setAttribute('role', 'option');
    this.dress(row);
    const cell = (name, text) => {
      const span = document.createElement('span');
      span.className = name;
      span.textContent = text;
      row.append(span);
    };
    const seconds = this.seconds?.[i + 1] ?? 0;
    cell('number', i + 1);
    cell('seconds', seconds > 0 ? `${seconds.toFixed(3)} s` : '');
    cell('text', this.lines[i]);
    return row;
  }
}
