// Graph of nodes and topics, and tree of frames: drawn as the server has placed them; drag moves, the wheel zooms.
import { element } from '../dom.js';

const SPACE = 'http://www.w3.org/2000/svg';
const LINE = 16;
const READABLE = 1.35; // most units of the drawing for a pixel at first
const LONGEST = 44; // characters of a line, as in simkit/recording/graphs/graph_svg.py

function shape(name, attributes, ...children) {
  const made = document.createElementNS(SPACE, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.append(...children);
  return made;
}

const shortened = text => text.length <= LONGEST ? text : `${text.slice(0, (LONGEST - 1) >> 1)}…${text.slice(-((LONGEST - 1) >> 1))}`;

/** Smooth pieces between columns, and straight lines through them. */
function curve(points) {
  let text = `M${points[0][0]} ${points[0][1]}`;
  for (let i = 1; i < points.length; i++) {
    const [x0, y0] = points[i - 1], [x, y] = points[i], bend = (x - x0) / 2;
    text += i % 2 ? `C${x0 + bend} ${y0} ${x - bend} ${y} ${x} ${y}` : `L${x} ${y}`;
  }
  return text;
}

class GraphView {
  constructor(id) {
    this.svg = shape('svg', { class: 'graph', id, tabindex: 0 });
    this.shown = '';
    this.view = null;
    this.svg.addEventListener('wheel', event => {
      event.preventDefault();
      this.zoom(Math.exp(event.deltaY * 0.0015), event.offsetX, event.offsetY);
    }, { passive: false });
    this.svg.addEventListener('dblclick', () => this.fit());
    this.svg.addEventListener('pointerdown', event => {
      this.svg.setPointerCapture(event.pointerId);
      let [x, y] = [event.clientX, event.clientY];
      const move = moved => {
        const scale = this.view[2] / this.svg.clientWidth;
        this.view[0] -= (moved.clientX - x) * scale; this.view[1] -= (moved.clientY - y) * scale;
        [x, y] = [moved.clientX, moved.clientY];
        this.apply();
      };
      this.svg.addEventListener('pointermove', move);
      this.svg.addEventListener('lostpointercapture', () => this.svg.removeEventListener('pointermove', move), { once: true });
    });
    new ResizeObserver(() => { if (!this.view || this.isFitted) this.begin(); else this.keepShape(); }).observe(this.svg);
  }

  zoom(factor, x, y) {
    if (!this.view) return;
    const [left, top, width, height] = this.view, size = Math.min(Math.max(width * factor, 80), 40000) / width;
    const px = left + width * x / this.svg.clientWidth, py = top + height * y / this.svg.clientHeight;
    this.view = [px - (px - left) * size, py - (py - top) * size, width * size, height * size];
    this.isFitted = false;
    this.apply();
  }

  keepShape() {
    this.view[3] = this.view[2] * this.svg.clientHeight / Math.max(this.svg.clientWidth, 1);
    this.apply();
  }

  /** Shows everything, at most at full size. */
  fit() {
    const { clientWidth: width, clientHeight: height } = this.svg;
    if (!this.size || !width || !height) return;
    const scale = Math.max((this.size[0] + 32) / width, (this.size[1] + 32) / height, 1);
    this.view = [this.size[0] / 2 - width * scale / 2, this.size[1] / 2 - height * scale / 2, width * scale, height * scale];
    this.isFitted = true;
    this.apply();
  }

  /** Shows everything if it is readable then; else the part at the root, or the top. */
  begin() {
    this.fit();
    if (!this.size || !this.view || this.view[2] / this.svg.clientWidth < READABLE) return;
    const { clientWidth: width, clientHeight: height } = this.svg, scale = Math.min(Math.max((this.size[0] + 32) / width, 1), READABLE);
    const left = this.size[0] > width * scale ? -16 : (this.size[0] - width * scale) / 2;
    this.view = [left, this.root === null ? -12 : this.root - height * scale / 2, width * scale, height * scale];
    this.isFitted = false;
    this.apply();
  }

  apply() { this.svg.setAttribute('viewBox', this.view.join(' ')); }

  draw({ boxes, edges, size }) {
    const text = JSON.stringify([boxes, edges]);
    if (text === this.shown) return;
    this.shown = text;
    const isNew = !this.size || this.isFitted || String(size) !== String(this.size);
    this.size = size;
    this.rates = new Map();
    const tip = shape('marker', { id: `${this.svg.id}-tip`, viewBox: '0 0 8 8', refX: 7, refY: 4, markerWidth: 7, markerHeight: 7, orient: 'auto' }, shape('path', { class: 'tip', d: 'M0 0L8 4L0 8z' }));
    const lines = edges.map(edge => {
      const line = shape('path', { class: `edge${edge.dashed ? ' dashed' : ''}`, d: curve(edge.points), 'marker-end': `url(#${this.svg.id}-tip)` });
      line.ends = edge.ends;
      return line;
    });
    this.svg.replaceChildren(shape('defs', {}, tip), ...lines, ...boxes.map(box => this.box(box, lines)));
    const first = boxes.filter(box => box.place[0] < 100 && boxes.every(one => one.place[0] >= box.place[0]));
    this.root = first.length === 1 ? first[0].place[1] + first[0].place[3] / 2 : null; // the middle of the only box on the left
    if (isNew) this.begin();
  }

  box({ name, kind, head, above, lines, place: [x, y, width, height] }, edges) {
    const rows = [...(above ? [[above, 'small']] : []), [head, 'head'], ...lines.map(line => [line, 'small'])];
    const texts = rows.map(([text, style], i) => shape('text', { class: style, x: x + width / 2, y: y + 18 + i * LINE, 'text-anchor': 'middle' }, shortened(text)));
    if (lines.at(-1) === '') this.rates.set(name, texts.at(-1));
    const group = shape('g', { class: `box ${kind}`, 'data-box': name }, shape('title', {}, name), shape('rect', { x, y, width, height, rx: kind === 'node' ? 6 : Math.min(height / 2, 16) }), ...texts);
    const mark = isOn => { for (const edge of edges) if (edge.ends.includes(name)) edge.classList.toggle('marked', isOn); };
    group.addEventListener('pointerenter', () => mark(true));
    group.addEventListener('pointerleave', () => mark(false));
    return group;
  }

  showRates(textOf) {
    for (const [name, line] of this.rates ?? []) line.textContent = textOf(name);
  }
}

const hertz = rate => rate === undefined ? '' : `${rate >= 10 ? rate.toFixed(1) : rate.toFixed(2)} Hz`;

function makeTab(app, id, stream, extra, isEmpty) {
  const view = new GraphView(id), note = element('p', { class: 'dim hint', hidden: true });
  const tools = element('div', { class: 'tab-tools' }, ...extra, element('button', { onclick: () => view.zoom(1 / 1.3, view.svg.clientWidth / 2, view.svg.clientHeight / 2), title: 'Zoom in' }, '+'),
    element('button', { onclick: () => view.zoom(1.3, view.svg.clientWidth / 2, view.svg.clientHeight / 2), title: 'Zoom out' }, '−'), element('button', { id: `${id}-fit`, onclick: () => view.fit(), title: 'Show everything' }, 'Fit'),
    element('span', { class: 'dim legend-text' }, 'drag: move, wheel: zoom'));
  app.on(`packet:${stream}`, packet => {
    view.draw(packet);
    note.hidden = packet.boxes.length > 0;
    note.textContent = packet.count > packet.most ? `${packet.count} boxes are too many to draw; use simkit graph` : isEmpty;
  });
  return { view, element: element('div', { class: 'graph-tab' }, tools, element('div', { class: 'graph-area' }, view.svg, note)) };
}

export function makeGraphTab(app) {
  let isShown = false, rates = {};
  const all = element('input', { type: 'checkbox', id: 'graph-all', onchange: () => want() });
  const { view, element: made } = makeTab(app, 'node-graph', 'graph', [element('label', { class: 'check' }, all, 'All names')], 'There are no nodes with topics.');
  const want = () => app.connection.want('graph', isShown ? { all: all.checked } : null);
  const show = () => view.showRates(name => hertz(rates[name.slice('topic '.length)]));
  app.on('packet:rates', packet => { rates = packet.rates; show(); });
  app.on('packet:graph', show);
  return {
    element: made,
    show(shown) {
      isShown = shown;
      want();
      app.connection.want('rates', shown ? {} : null);
    },
  };
}

export function makeFrameTab(app) {
  const { view, element: made } = makeTab(app, 'frame-graph', 'frames', [], 'No transforms have come yet.');
  app.on('packet:frames', ({ rates, ages }) => view.showRates(name => name in ages ? `silent for ${ages[name]} s` : hertz(rates[name])));
  return { element: made, show(shown) { app.connection.want('frames', shown ? {} : null); } };
}
