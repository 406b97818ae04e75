// One plot: curves over time, with pause, zoom, and export as CSV and PNG.
import uPlot from 'uplot';
import { element } from '../dom.js';
import { FIELD_DATA } from './topic_list.js';

const COLOURS = ['#4c9ffe', '#f2a33c', '#3fbf7f', '#e5636b', '#b38cf4', '#2fc4c9', '#e87fbf', '#a8b545', '#8d99ae', '#d98e5f'];
const STEPS = Array.from({ length: 49 }, (_, i) => [1, 2, 5].map(step => +`${step}e${i - 24}`)).flat(); // between two values of an axis; 2.5 would need more digits
const WINDOWS = [['5 s', 5], ['10 s', 10], ['30 s', 30], ['60 s', 60], ['5 min', 300], ['all', Infinity]];

export class Plot {
  /** `close(plot)` is called by the button with the cross, `select(plot)` by a click, `changed()` for other fields. */
  constructor(app, store, { close, select, changed }) {
    Object.assign(this, { app, store, changed });
    this.fields = [];
    this.zoom = null;
    this.isPaused = this.usesStamps = this.inDegrees = false;
    this.shape = '';
    this.colours = new Map();
    const button = (name, text, title, onclick) => element('button', { class: name, title, 'aria-label': title, onclick }, text);
    this.pause = button('pause', '❚❚', 'Pause or resume the drawing; data are kept', () => this.setPaused(!this.isPaused));
    this.range = element('select', { class: 'range', title: 'Shown time', onchange: () => { this.zoom = null; this.draw(); } }, ...WINDOWS.map(([text]) => element('option', {}, text)));
    this.range.selectedIndex = app.scene?.recording ? WINDOWS.length - 1 : 2;
    this.axis = element('select', { class: 'axis', title: 'Time axis', onchange: () => { this.usesStamps = this.axis.selectedIndex === 1; this.zoom = null; this.draw(); } },
      element('option', {}, 'receive time'), element('option', {}, 'header stamp'));
    this.degrees = button('degrees', '°', 'Show angles in degrees', () => {
      this.inDegrees = !this.inDegrees;
      this.degrees.classList.toggle('on', this.inDegrees);
      this.draw();
    });
    this.legend = element('div', { class: 'legend' });
    this.area = element('div', { class: 'area' });
    this.hint = element('p', { class: 'hint dim' }, 'Drag fields here, or click them in the list');
    const clear = button('clear', 'Clear', 'Drop the samples', () => this.clear());
    clear.hidden = Boolean(app.scene?.recording); // a recording has no later samples
    const tools = element('div', { class: 'plot-tools' }, this.pause, this.range, this.axis, this.degrees,
      clear, button('csv', 'CSV', 'Save the samples as CSV', () => this.saveCsv()),
      button('png', 'PNG', 'Save the picture', () => this.savePng()), button('close', '✕', 'Close the plot', () => close(this)));
    this.element = element('div', { class: 'plot' }, element('div', { class: 'plot-head' }, this.legend, tools), this.area);
    this.area.append(this.hint);
    this.element.addEventListener('pointerdown', () => select(this));
    this.element.addEventListener('dragover', event => { event.preventDefault(); this.element.classList.add('over'); });
    this.element.addEventListener('dragleave', () => this.element.classList.remove('over'));
    this.element.addEventListener('drop', event => {
      event.preventDefault();
      this.element.classList.remove('over');
      try { this.add(...JSON.parse(event.dataTransfer.getData(FIELD_DATA))); } catch { /* something else was dropped */ }
    });
    this.size = new ResizeObserver(() => this.resize());
    this.size.observe(this.area);
  }

  add(topic, field) {
    if (!field || this.fields.some(one => one.topic === topic && one.field === field)) return;
    this.fields.push({ topic, field });
    this.store.use(topic, field, true);
    this.changed();
    this.draw();
  }

  remove(topic, field) {
    this.fields = this.fields.filter(one => one.topic !== topic || one.field !== field);
    this.store.use(topic, field, false);
    this.changed();
    this.draw();
  }

  close() {
    for (const { topic, field } of [...this.fields]) this.remove(topic, field);
    this.size.disconnect();
    this.chart?.destroy();
  }

  clear() {
    for (const { topic, field } of this.fields) this.store.clear(topic, field);
    this.zoom = null;
    this.draw();
  }

  setPaused(isPaused) {
    this.isPaused = isPaused;
    this.pause.textContent = isPaused ? '▶' : '❚❚';
    this.pause.classList.toggle('on', isPaused);
    if (!isPaused) this.draw();
  }

  curves() {
    const found = this.fields.flatMap(({ topic, field }) => this.store.of(topic, field));
    return [...new Map(found.map(curve => [curve.key, curve])).values()];
  }

  colourOf(curve) {
    if (!this.colours.has(curve.key)) {
      const used = new Set(this.curves().map(one => this.colours.get(one.key)));
      this.colours.set(curve.key, COLOURS.find(colour => !used.has(colour)) ?? COLOURS[this.colours.size % COLOURS.length]);
    }
    return this.colours.get(curve.key);
  }

  scale(curve) { return this.inDegrees && curve.unit === 'rad' ? 180 / Math.PI : 1; }
  unit(curve) { return this.inDegrees && curve.unit === 'rad' ? '°' : curve.unit; }
  times(curve) { return this.usesStamps && curve.s.some(Number.isFinite) ? curve.s : curve.t; }

  /** Returns the shown range of time. */
  limits(curves) {
    if (this.zoom) return this.zoom;
    const ends = curves.map(curve => this.times(curve)).filter(times => times.length);
    if (!ends.length) return [0, 1];
    const end = Math.max(...ends.map(times => times[times.length - 1])), begin = Math.min(...ends.map(times => times[0]));
    return [Math.max(begin, end - WINDOWS[this.range.selectedIndex][1]), Math.max(end, begin + 0.1)];
  }

  /** Draws the newest samples. */
  draw() {
    if (this.isPaused && this.chart) { this.showLegend(); return; }
    const curves = this.curves();
    this.hint.hidden = this.fields.length > 0;
    this.make(curves);
    this.showLegend();
    if (!this.chart) return;
    const [low, high] = this.limits(curves);
    this.chart.batch(() => {
      this.chart.setData(this.table(curves, low, high), false);
      this.chart.setScale('x', { min: low, max: high });
    });
  }

  /** Returns the samples in a range of time, in the form of uPlot: one column of times, and one for each curve. */
  table(curves, low, high) {
    if (!curves.length) return [[]];
    const tables = curves.map(curve => {
      const times = this.times(curve), from = Math.max(0, bisect(times, low) - 1), to = Math.min(times.length, bisect(times, high) + 1), scale = this.scale(curve);
      const t = [], v = [];
      for (let i = from; i < to; i++) {
        if (!Number.isFinite(times[i]) || (t.length && times[i] <= t[t.length - 1])) continue;
        t.push(times[i]); v.push(Number.isFinite(curve.v[i]) ? curve.v[i] * scale : null);
      }
      return [t, v];
    });
    return tables.length === 1 ? tables[0] : uPlot.join(tables);
  }

  /** Makes the chart anew if its curves or units have changed. */
  make(curves) {
    const shape = JSON.stringify([curves.map(curve => [curve.key, this.unit(curve)]), matchMedia('(prefers-color-scheme: light)').matches]);
    if (shape === this.shape) return;
    this.shape = shape;
    this.chart?.destroy();
    this.chart = null;
    if (!curves.length) return;
    const style = getComputedStyle(document.body), text = style.getPropertyValue('--dim').trim(), line = style.getPropertyValue('--grid').trim();
    const font = '11px system-ui, sans-serif', all = [...new Set(curves.map(curve => this.unit(curve)))], units = all.slice(0, 2);
    const scaleOf = curve => units.includes(this.unit(curve)) ? `u${units.indexOf(this.unit(curve))}` : `u${units.length - 1}`;
    const axis = (options) => ({ stroke: text, font, labelFont: font, labelSize: 16, grid: { stroke: line, width: 1 }, ticks: { stroke: line, width: 1, size: 4 }, gap: 3, incrs: STEPS, values: ticks, ...options });
    const scales = { x: { time: false }, ...Object.fromEntries(units.map((_, i) => [`u${i}`, { range: (u, min, max) => padded(min, max) }])) };
    const { width, height } = this.space();
    this.chart = new uPlot({
      width, height, scales, legend: { show: false }, padding: [8, units.length > 1 ? 0 : 12, 0, 0],
      cursor: { drag: { x: true, y: false, setScale: false }, points: { size: 5 }, focus: { prox: 24 } },
      focus: { alpha: 0.4 },
      series: [{}, ...curves.map(curve => ({ label: curve.label, stroke: this.colourOf(curve), width: 1.5, scale: scaleOf(curve), points: { show: false }, spanGaps: false, pxAlign: 0, paths: curve.isAngle ? anglePath(scaleOf(curve), Math.PI * this.scale(curve)) : undefined }))],
      axes: [axis({ size: 24 }), ...units.map((unit, i) => axis({ scale: `u${i}`, side: i ? 1 : 3, size: 52, label: (i ? all.slice(1) : [unit]).filter(Boolean).join(', ') || ' ', grid: { show: i === 0, stroke: line, width: 1 } }))],
      hooks: {
        setSelect: [u => this.setZoom(u)],
        setCursor: [() => this.showValues()],
        draw: [u => this.drawNow(u)],
        ready: [u => u.over.addEventListener('dblclick', () => { this.zoom = null; this.draw(); })],
      },
    }, [[], ...curves.map(() => [])], this.area);
  }

  setZoom(u) {
    const { left, width } = u.select;
    if (width < 4) return;
    this.zoom = [u.posToVal(left, 'x'), u.posToVal(left + width, 'x')];
    u.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
    if (this.isPaused) u.setScale('x', { min: this.zoom[0], max: this.zoom[1] });
    else this.draw();
  }

  /** Draws a line at the present time of a recording. */
  drawNow(u) {
    if (!this.app.player || !this.app.state) return;
    const x = u.valToPos(this.app.state.time, 'x', true), { left, top, width, height } = u.bbox;
    if (x < left || x > left + width) return;
    u.ctx.fillStyle = '#f2a33c';
    u.ctx.fillRect(Math.round(x), top, Math.max(1, devicePixelRatio), height);
  }

  showLegend() {
    const known = this.legendOf?.join() === this.legendKey();
    if (!known) {
      this.legendOf = [this.legendKey()];
      this.legend.replaceChildren(...this.fields.flatMap(({ topic, field }) => {
        const drop = () => element('button', { class: 'drop', title: 'Remove', 'aria-label': `Remove ${field}`, onclick: () => this.remove(topic, field) }, '✕');
        const curves = this.store.of(topic, field), error = this.store.errors.get(`${topic} ${field}`);
        if (!curves.length) return [element('span', { class: `key ${error ? 'wrong' : ''}`, title: error ?? '' }, error ? `${field}: ${error}` : `${topic}.${field} …`, drop())];
        return curves.map((curve, i) => {
          const swatch = element('i', {}), value = element('output', {});
          swatch.style.background = this.colourOf(curve);
          return element('span', { class: 'key', title: curve.label, 'data-curve': curve.key }, swatch, element('span', { class: 'label' }, element('bdi', {}, curve.label)), value, i ? null : drop());
        });
      }));
    }
    this.showValues();
  }

  legendKey() {
    return JSON.stringify(this.fields.map(({ topic, field }) => [topic, field, this.store.of(topic, field).map(curve => curve.key), this.store.errors.get(`${topic} ${field}`)]));
  }

  /** Shows the values under the cursor, else the newest ones. */
  showValues() {
    const at = this.chart?.cursor.left >= 0 ? this.chart.posToVal(this.chart.cursor.left, 'x') : null;
    for (const key of this.legend.querySelectorAll('[data-curve]')) {
      const curve = this.store.curves.get(key.dataset.curve);
      if (!curve?.v.length) { key.querySelector('output').textContent = ''; continue; }
      const time = at ?? (this.app.player ? this.app.state?.time ?? 0 : Infinity), i = Math.max(0, bisect(this.times(curve), time) - 1), value = curve.v[Math.min(i, curve.v.length - 1)];
      key.querySelector('output').textContent = `${format(value * this.scale(curve))}${this.unit(curve) ? ` ${this.unit(curve)}` : ''}`;
    }
  }

  space() { return { width: Math.max(120, this.area.clientWidth), height: Math.max(80, this.area.clientHeight) }; }

  resize() {
    if (this.chart && this.area.clientWidth) this.chart.setSize(this.space());
  }

  // ---- export

  csv() {
    const curves = this.curves(), rows = new Map();
    curves.forEach((curve, k) => this.times(curve).forEach((time, i) => {
      if (!rows.has(time)) rows.set(time, new Array(curves.length).fill(''));
      rows.get(time)[k] = Number.isFinite(curve.v[i]) ? curve.v[i] : 'nan';
    }));
    const quote = text => /[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
    const head = ['time [s]', ...curves.map(curve => quote(curve.label + (curve.unit ? ` [${curve.unit}]` : '')))];
    const lines = [...rows].sort((a, b) => a[0] - b[0]).map(([time, values]) => [+time.toFixed(9), ...values.map(value => typeof value === 'number' ? +value.toPrecision(9) : value)].join(','));
    return [head.join(','), ...lines, ''].join('\n');
  }

  saveCsv() { save(new Blob([this.csv()], { type: 'text/csv' }), 'simkit-plot.csv'); }

  /** Returns a canvas with the chart and its legend. */
  picture() {
    const style = getComputedStyle(document.body), from = this.chart.ctx.canvas, scale = from.width / this.chart.width, row = 18 * scale, curves = this.curves();
    const canvas = element('canvas', { width: from.width, height: from.height + row * curves.length + 8 * scale }), context = canvas.getContext('2d');
    context.fillStyle = style.getPropertyValue('--panel');
    context.fillRect(0, 0, canvas.width, canvas.height);
    context.font = `${12 * scale}px system-ui, sans-serif`;
    curves.forEach((curve, i) => {
      const y = (i + 0.8) * row;
      context.fillStyle = this.colourOf(curve);
      context.fillRect(12 * scale, y - 8 * scale, 14 * scale, 8 * scale);
      context.fillStyle = style.getPropertyValue('--text');
      context.fillText(curve.label + (this.unit(curve) ? ` [${this.unit(curve)}]` : ''), 32 * scale, y);
    });
    context.drawImage(from, 0, row * curves.length + 8 * scale);
    return canvas;
  }

  savePng() { if (this.chart) this.picture().toBlob(blob => save(blob, 'simkit-plot.png'), 'image/png'); }
}

/** Offers a file for download. */
function save(blob, name) {
  const url = URL.createObjectURL(blob), link = element('a', { href: url, download: name });
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(url), 10000);
}

/** Returns the number of values that are at most `value`; the values increase. */
function bisect(values, value) {
  let low = 0, high = values.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (values[middle] <= value) low = middle + 1; else high = middle;
  }
  return low;
}

function padded(min, max) {
  if (min === null || max === null) return [-1, 1];
  const space = max > min ? 0.08 * (max - min) : Math.max(Math.abs(max) * 0.1, 0.1);
  return [min - space, max + space];
}

/** Returns the path of an angle: without a line where it wraps around. uPlot draws gaps only where they are wider than a pixel. */
function anglePath(scale, half) {
  return (u, number, from, to) => {
    const stroke = new Path2D(), times = u.data[0], values = u.data[number];
    let last = null;
    for (let i = from; i <= to; i++) {
      const value = values[i];
      if (value === undefined) continue;
      if (value === null) { last = null; continue; }
      const x = u.valToPos(times[i], 'x', true), y = u.valToPos(value, scale, true);
      if (last === null || Math.abs(value - last) > half) stroke.moveTo(x, y); else stroke.lineTo(x, y);
      last = value;
    }
    return { stroke, fill: null, clip: null, flags: 1 };
  };
}

/** Returns the texts of an axis: as many digits as the distance between two values needs. */
function ticks(u, values, axis, space, step) {
  const largest = Math.max(...values.map(Math.abs)), digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  if (digits > 5 || largest >= 1e6) return values.map(value => value === 0 ? '0' : value.toExponential(Math.max(0, Math.min(2, Math.round(Math.log10(largest / step))))));
  return values.map(value => (Math.abs(value) < step / 2 ? 0 : value).toFixed(digits));
}

function format(value) {
  if (!Number.isFinite(value)) return '–';
  const size = Math.abs(value);
  return size !== 0 && (size < 1e-3 || size >= 1e6) ? value.toExponential(3) : String(+value.toFixed(4));
}
