// List of topics with types, rates and fields. A field is dragged to a plot, or clicked.
import { element } from '../dom.js';
import { READERS, TRUTH } from './series_store.js';

/** Type of the data of a dragged field. */
export const FIELD_DATA = 'text/plain';

export class TopicList {
  /** `choose(topic, field)` is called for a click on a field. */
  constructor(app, store, choose) {
    Object.assign(this, { app, store, choose });
    this.topics = [];
    this.types = {};
    this.rates = {};
    this.models = [];
    this.truth = [];
    this.open = new Set();
    this.search = element('input', { id: 'topic-search', type: 'search', placeholder: 'Find a topic or field', oninput: () => this.show() });
    this.path = element('input', { id: 'topic-path', placeholder: '/topic.field, Enter', title: 'For example /scan.ranges[180] or /odom.pose.pose.position',
      onkeydown: event => { if (event.key === 'Enter' && this.add(this.path.value.trim())) this.path.value = ''; } });
    this.list = element('div', { class: 'topic-rows' });
    this.element = element('div', { class: 'topics' }, this.search, this.path, this.list);
    app.on('packet:topics', packet => this.take(packet));
    app.on('packet:rates', ({ rates }) => {
      this.rates = rates;
      for (const cell of this.list.querySelectorAll('[data-rate]')) cell.textContent = this.rateOf(cell.dataset.rate);
    });
  }

  setShown(isShown) {
    if (this.store.file) {
      if (!this.topics.length) this.take(this.store.file.get('topics') ?? { topics: [], types: {}, models: [...this.app.bodyOf.keys()], truth: Object.keys(READERS) });
      return;
    }
    this.app.connection.want('topics', isShown ? {} : null);
    if (!this.app.scene?.recording) this.app.connection.want('rates', isShown ? {} : null);
  }

  take({ topics, types, models, truth }) {
    Object.assign(this, { topics, types, models, truth });
    if (this.store.file) for (const topic of topics) {
      topic.fields = [...new Set((this.store.file.get(topic.name)?.curves ?? []).map(curve => curve.path))];
    }
    this.rates = Object.fromEntries(topics.filter(topic => topic.rate).map(topic => [topic.name, topic.rate]).concat(Object.entries(this.rates)));
    this.show();
  }

  rateOf(topic) {
    const rate = this.rates[topic];
    return rate === undefined ? '' : `${rate >= 100 ? rate.toFixed(0) : rate >= 10 ? rate.toFixed(1) : rate.toFixed(2)} Hz`;
  }

  fieldsOf(topic) { return topic.fields ?? this.types[topic.type] ?? []; }

  /** Adds a field by its text, such as `/odom.twist.twist.linear.x` or `rover.x`; returns true if there is such a topic. */
  add(text) {
    const found = this.topics.map(topic => topic.name).filter(name => text.startsWith(name) && './['.includes(text[name.length] ?? ' ')).sort((a, b) => b.length - a.length)[0];
    const isModel = this.models.some(name => text.startsWith(`${name}.`));
    if (found) this.choose(found, text.slice(found.length).replace(/^[./]/, ''));
    else if (isModel) this.choose(TRUTH, text);
    else this.app.report(`there is no topic with numbers for ${text}`);
    return Boolean(found) || isModel;
  }

  show() {
    const text = this.search.value.trim().toLowerCase(), rows = [];
    const matches = (name, fields) => !text || name.toLowerCase().includes(text) || fields.some(field => `${name}.${field}`.toLowerCase().includes(text));
    for (const name of this.models) {
      const fields = this.truth.map(value => `${name}.${value}`);
      if (matches(`${name} (truth)`, fields)) rows.push(this.row(`truth:${name}`, name, 'true pose and velocity', null, () => fields.map(field => [TRUTH, field, field.slice(name.length + 1)])));
    }
    for (const topic of this.topics) {
      const fields = this.fieldsOf(topic);
      if (fields.length && matches(topic.name, fields)) rows.push(this.row(topic.name, topic.name, topic.type, topic.name, () => fields.filter(field => !text || topic.name.toLowerCase().includes(text) || field.toLowerCase().includes(text)).map(field => [topic.name, field, field])));
    }
    this.list.replaceChildren(...rows.length ? rows : [element('p', { class: 'dim' }, this.topics.length ? 'nothing found' : 'no topics')]);
  }

  row(key, name, type, rated, makeFields) {
    const rate = rated === null ? null : element('span', { class: 'rate', 'data-rate': rated }, this.rateOf(rated));
    const box = element('details', { 'data-topic': key, open: this.open.has(key) },
      element('summary', { title: `${name}\n${type}` }, element('span', { class: 'name' }, name), rate, element('span', { class: 'type' }, type.replace('/msg/', '/'))));
    const fill = () => { if (box.open && box.childElementCount === 1) box.append(...makeFields().map(([topic, field, text]) => this.field(topic, field, text))); };
    box.addEventListener('toggle', () => {
      if (box.open) this.open.add(key); else this.open.delete(key);
      fill();
    });
    fill();
    return box;
  }

  /** Returns a field, with an input for each index. */
  field(topic, field, text) {
    const parts = text.split('[]'), inputs = parts.slice(1).map(() => element('input', { class: 'index', value: '0', size: 3, title: 'Index, name, or range such as 0:5' }));
    const read = () => field.split('[]').map((part, i) => part + (i < inputs.length ? `[${inputs[i].value.trim() || 0}]` : '')).join('');
    const shown = parts.flatMap((part, i) => i < inputs.length ? [`${part}[`, inputs[i], ']'] : [part]);
    const row = element('div', { class: 'field', draggable: true, tabIndex: 0, role: 'button', title: 'Drag to a plot, or click', 'data-field': field }, ...shown);
    row.addEventListener('dragstart', event => {
      event.dataTransfer.setData(FIELD_DATA, JSON.stringify([topic, read()]));
      event.dataTransfer.effectAllowed = 'copy';
    });
    row.addEventListener('click', event => { if (event.target.tagName !== 'INPUT') this.choose(topic, read()); });
    row.addEventListener('keydown', event => { if (event.key === 'Enter') this.choose(topic, read()); });
    return row;
  }
}
