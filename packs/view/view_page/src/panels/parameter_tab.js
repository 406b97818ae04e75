// Live parameters of all nodes: sliders where a range is declared, else fields.
import { element } from '../dom.js';

export function makeParameterTab(app) {
  const list = element('div', { class: 'parameter-nodes' }), search = element('input', { id: 'parameter-search', type: 'search', placeholder: 'Find a node or parameter', oninput: () => filter() });
  const rows = new Map();
  let shape = '';

  const set = async (node, name, value, row) => {
    try { await app.ask('set_parameter', { node, name, value }); }
    catch (error) { app.report(error.message); row.show(row.value); }
  };
  const make = (node, name, parameter) => {
    const control = makeControl(parameter, value => set(node, name, value, row));
    const row = { value: parameter.value, show: control.show, isBusy: control.isBusy,
      element: element('div', { class: 'parameter', 'data-parameter': `${node} ${name}`, title: `${parameter.description || name}\n${parameter.allowed}` }, element('span', { class: 'name' }, name), control.element, element('span', { class: 'dim about' }, parameter.description || parameter.allowed)) };
    return row;
  };
  const filter = () => {
    const text = search.value.trim().toLowerCase();
    for (const box of list.querySelectorAll('details')) {
      let any = false;
      for (const row of box.querySelectorAll('.parameter')) { row.hidden = !row.dataset.parameter.toLowerCase().includes(text); any ||= !row.hidden; }
      box.hidden = !any;
    }
  };
  app.on('packet:parameters', ({ nodes }) => {
    const found = JSON.stringify(Object.entries(nodes).map(([node, parameters]) => [node, Object.entries(parameters).map(([name, one]) => [name, one.allowed, one.type])]));
    if (found !== shape) {
      shape = found;
      rows.clear();
      const few = Object.keys(nodes).length < 4;
      list.replaceChildren(...Object.entries(nodes).map(([node, parameters]) => element('details', { open: few }, element('summary', {}, node, element('span', { class: 'dim' }, ` ${Object.keys(parameters).length}`)),
        ...Object.entries(parameters).map(([name, parameter]) => {
          const row = make(node, name, parameter);
          rows.set(`${node} ${name}`, row);
          return row.element;
        }))));
      if (!Object.keys(nodes).length) list.append(element('p', { class: 'dim' }, 'no node has parameters'));
      filter();
    }
    for (const [node, parameters] of Object.entries(nodes)) for (const [name, parameter] of Object.entries(parameters)) {
      const row = rows.get(`${node} ${name}`);
      row.value = parameter.value;
      if (!row.isBusy()) row.show(parameter.value);
    }
  });
  return {
    element: element('div', { class: 'parameter-tab' }, element('div', { class: 'tab-tools' }, search), list),
    show(shown) { app.connection.want('parameters', shown ? {} : null); },
  };
}

/** Returns the input of a parameter: `show(value)`, and `isBusy()` while the user changes it. */
function makeControl(parameter, send) {
  const { type, minimum, maximum, choices, value } = parameter;
  const isBusy = input => () => document.activeElement === input && !input.matches('[type=checkbox], select');
  if (choices.length) {
    const input = element('select', { onchange: () => send(choices[input.selectedIndex]) }, ...choices.map(choice => element('option', {}, String(choice))));
    return { element: input, show: shown => { input.selectedIndex = choices.indexOf(shown); }, isBusy: () => false };
  }
  if (type === 'bool') {
    const input = element('input', { type: 'checkbox', onchange: () => send(input.checked) });
    return { element: input, show: shown => { input.checked = shown; }, isBusy: () => false };
  }
  if (type === 'int' || type === 'float') {
    const step = type === 'int' ? 1 : 'any';
    const number = element('input', { type: 'number', step, min: minimum ?? '', max: maximum ?? '', onchange: () => { if (number.value !== '') send(+number.value); } });
    if (minimum === null || maximum === null) return { element: element('span', { class: 'number' }, number), show: shown => { number.value = shown; }, isBusy: isBusy(number) };
    const slider = element('input', { type: 'range', min: minimum, max: maximum, step: type === 'int' ? 1 : (maximum - minimum) / 1000, 'aria-label': 'Value', oninput: () => { number.value = +(+slider.value).toPrecision(6); send(+number.value); } });
    return { element: element('span', { class: 'number' }, slider, number), show: shown => { slider.value = shown; number.value = +(+shown).toPrecision(8); }, isBusy: () => isBusy(number)() || slider.matches(':active') };
  }
  const isTuple = Array.isArray(value);
  const input = element('input', { onchange: () => send(isTuple ? input.value.split(/[\s,;]+/).filter(Boolean).map(Number) : input.value) });
  return { element: input, show: shown => { input.value = isTuple ? shown.join(', ') : shown; }, isBusy: isBusy(input) };
}
