// The program's text beside the view. Only the lines that are seen are there as elements.

class ProgramText {
  constructor(element, lines) {
    this.element = element;
    this.space = element.firstElementChild;
    this.lines = lines;
    this.height = 20;  // px, as the style has it
    this.current = 0;
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
    this.render();
  }
  mark(line) {
    if (line === this.current) return;
    this.current = line;
    const top = (line - 1) * this.height, seen = this.element.clientHeight;
    if (line > 0 && (top < this.element.scrollTop || top + this.height > this.element.scrollTop + seen))
      this.element.scrollTop = top - seen / 2;
    this.render();
  }

  render() {
    const first = Math.max(0, Math.floor(this.element.scrollTop / this.height) - 5);
    const end = Math.min(this.lines.length, first + Math.ceil(this.element.clientHeight / this.height) + 10);
    const rows = [];
    for (let i = first; i < end; ++i) rows.push(this.row(i));
    this.space.replaceChildren(...rows);
  }
  row(i) {
    const row = document.createElement('div');
    row.className = i + 1 === this.current ? 'line current' : 'line';
    row.style.top = `${i * this.height}px`;
    row.dataset.line = i + 1;
    row.setAttribute('role', 'option');
    row.setAttribute('aria-selected', i + 1 === this.current);
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
