// Form for a message type: inputs with the limits of the type, for nested messages and arrays, too.
import { element } from '../dom.js';

const DEEPEST_OPEN = 2;

/** Form of a description from the request `describe`. `read()` returns the values; it throws an error if some are wrong. */
export class Form {
  constructor({ type, types }) {
    this.types = types;
    this.root = this.message(type, types[type].default, 0);
    this.element = element('div', { class: 'form' }, this.root.element);
    if (!types[type].fields.length) this.element.append(element('p', { class: 'dim' }, 'no fields'));
  }

  read() {
    const wrong = [];
    const values = this.root.read(wrong, '');
    if (wrong.length) throw new Error(wrong.join('; '));
    return values;
  }

  message(type, values, depth) {
    const found = this.types[type], parts = found.fields.map(field => [field, this.field(field, values?.[field.name] ?? found.default[field.name], depth)]);
    return {
      element: element('div', { class: 'fields' }, ...parts.map(([, part]) => part.element)),
      read: (wrong, path) => Object.fromEntries(parts.map(([field, part]) => [field.name, part.read(wrong, path ? `${path}.${field.name}` : field.name)])),
    };
  }

  field(field, value, depth) {
    const title = `${field.name}: ${field.type}${field.array ? `[${field.array.length || ''}]` : ''}${limitsOf(field)}`;
    if (field.array) return this.array(field, value ?? [], depth, title);
    if (field.kind === 'message') {
      const inner = this.message(field.type, value, depth + 1);
      const box = element('details', { class: 'nested', open: depth < DEEPEST_OPEN }, element('summary', { title }, field.name, element('span', { class: 'type' }, field.type.replace('/msg/', '/'))), inner.element);
      return { element: box, read: inner.read };
    }
    const input = scalar(field, value);
    return { element: element('label', { class: 'field-row', title }, element('span', {}, field.name), input.element), read: input.read };
  }

  array(field, values, depth, title) {
    if (field.kind === 'number' || field.kind === 'integer') return this.numbers(field, values, title);
    const rows = element('div', { class: 'items' }), items = [];
    const most = field.array.length || field.array.most || 1000;
    const add = value => {
      if (items.length >= most) return;
      const item = field.kind === 'message' ? this.message(field.type, value, depth + 1) : scalar(field, value ?? (field.kind === 'bool' ? false : ''));
      const drop = element('button', { class: 'drop', title: 'Remove', hidden: field.array.length > 0, onclick: () => { items.splice(items.indexOf(item), 1); box.remove(); count(); } }, '✕');
      const box = element('div', { class: 'item' }, item.element, drop);
      items.push(item);
      rows.append(box);
      count();
    };
    const number = element('span', { class: 'dim' }), more = element('button', { class: 'more', hidden: field.array.length > 0, onclick: () => add(null) }, '+');
    const count = () => { number.textContent = `${items.length} item${items.length === 1 ? '' : 's'}`; };
    const box = element('details', { class: 'nested', open: depth < DEEPEST_OPEN }, element('summary', { title }, field.name, element('span', { class: 'type' }, `${field.type.replace('/msg/', '/')}[]`), number), rows, more);
    count();
    for (const value of values) add(value);
    return { element: box, read: (wrong, path) => items.map((item, i) => item.read(wrong, `${path}[${i}]`)) };
  }

  /** Returns an input for a list of numbers, with commas or spaces between them. */
  numbers(field, values, title) {
    const input = element('input', { value: values.join(', '), placeholder: 'numbers, with commas between them', spellcheck: false });
    const read = (wrong, path) => {
      const texts = input.value.split(/[\s,;]+/).filter(Boolean), { length, most } = field.array;
      const found = texts.map((text, i) => checked(field, text, wrong, `${path}[${i}]`));
      if (length && found.length !== length) wrong.push(`${path}: ${length} numbers are needed, found ${found.length}`);
      if (most && found.length > most) wrong.push(`${path}: at most ${most} numbers, found ${found.length}`);
      input.classList.toggle('wrong', wrong.some(text => text.startsWith(path)));
      return found;
    };
    return { element: element('label', { class: 'field-row', title }, element('span', {}, field.name), input), read };
  }
}

function limitsOf(field) {
  if (field.kind === 'integer') return `, ${field.low} to ${field.high}`;
  return field.kind === 'text' && field.most ? `, at most ${field.most} characters` : '';
}

/** Returns the number of a text; a wrong one is added to `wrong`. */
function checked(field, text, wrong, path) {
  if (field.kind === 'number' && /^[+-]?nan$/i.test(text)) return null;
  const value = text.trim() === '' ? NaN : Number(text);
  if (!Number.isFinite(value) || (field.kind === 'integer' && !Number.isInteger(value))) wrong.push(`${path}: found ${JSON.stringify(text)}, expected a ${field.kind === 'integer' ? 'whole ' : ''}number`);
  else if (value < field.low || value > field.high) wrong.push(`${path}: ${value} is outside ${field.low} to ${field.high}`);
  return value;
}

/** Returns an input for one value: a checkbox, a number, a text, or a list of constants. */
function scalar(field, value) {
  if (field.kind === 'bool') {
    const input = element('input', { type: 'checkbox', checked: Boolean(value), name: field.name });
    return { element: input, read: () => input.checked };
  }
  const input = element('input', { value: value ?? (field.kind === 'number' ? 'nan' : ''), name: field.name, spellcheck: false });
  if (field.kind === 'text') { if (field.most) input.maxLength = field.most; } else input.inputMode = 'decimal';
  const read = (wrong, path) => {
    const before = wrong.length, found = field.kind === 'text' ? input.value : checked(field, input.value, wrong, path);
    input.classList.toggle('wrong', wrong.length > before);
    return found;
  };
  if (!field.constants?.length) return { element: input, read };
  const choice = element('select', { name: field.name, onchange: () => change() }, ...field.constants.map(([name, constant]) => element('option', { value: constant }, `${name} = ${constant}`)), element('option', { value: '' }, 'other …'));
  const change = () => {
    const constant = field.constants[choice.selectedIndex];
    input.hidden = Boolean(constant);
    if (constant) input.value = constant[1];
  };
  const index = field.constants.findIndex(([, constant]) => constant === value);
  choice.selectedIndex = index < 0 ? field.constants.length : index;
  input.hidden = index >= 0;
  return { element: element('span', { class: 'choice' }, choice, input), read };
}
