// Services and actions: a form of the type, the response, and the progress of goals.
import { element } from '../dom.js';
import { makeCallList } from './call_list.js';
import { Form } from './form.js';

export function makeCallTab(app) {
  let services = {}, actions = {}, chosen = null, form = null;
  const search = element('input', { id: 'call-search', type: 'search', placeholder: 'Find a service or action', oninput: () => show() });
  const list = element('div', { class: 'call-names' }), head = element('div', { class: 'call-title' }), place = element('div', { class: 'call-form' });
  const send = element('button', { id: 'call-send', onclick: () => submit() }, 'Call'), problem = element('p', { id: 'call-problem', class: 'wrong', hidden: true });
  const response = element('pre', { id: 'call-response', hidden: true }), calls = makeCallList(app);
  const hint = element('p', { class: 'dim hint' }, 'Choose a service or an action');
  const middle = element('div', { class: 'call-middle' }, hint, head, problem, response, place);

  const tell = text => { problem.textContent = text; problem.hidden = !text; };
  const show = () => {
    const text = search.value.trim().toLowerCase();
    const section = (title, names, kind) => {
      const found = Object.keys(names).filter(name => !text || name.toLowerCase().includes(text) || names[name].toLowerCase().includes(text)).sort();
      return found.length ? [element('h4', {}, title), ...found.map(name => element('button', { class: `leaf ${chosen?.name === name ? 'selected' : ''}`, title: `${name}\n${names[name]}`, 'data-call-name': name, onclick: () => choose(kind, name, names[name]) }, name))] : [];
    };
    const rows = [...section('Actions', actions, 'action'), ...section('Services', services, 'service')];
    list.replaceChildren(...rows.length ? rows : [element('p', { class: 'dim' }, 'nothing found')]);
  };
  const choose = async (kind, name, type) => {
    chosen = { kind, name, type };
    form = null;
    send.disabled = true;
    show();
    tell('');
    response.hidden = true;
    try {
      const found = new Form(await app.ask('describe', { kind, name }));
      if (chosen?.name !== name) return;
      form = found;
      send.disabled = false;
      hint.hidden = true;
      head.replaceChildren(element('strong', {}, name), element('span', { class: 'type' }, type), send);
      place.replaceChildren(form.element);
      send.textContent = kind === 'action' ? 'Send goal' : 'Call';
    } catch (error) { if (chosen?.name === name) tell(error.message); }
  };
  const submit = async () => {
    if (!form) return;
    tell('');
    response.hidden = true;
    send.disabled = true;
    try {
      const values = form.read();
      const answer = await app.ask(chosen.kind === 'action' ? 'goal' : 'call', { name: chosen.name, values });
      if (answer.text !== undefined) { response.textContent = answer.text || 'done'; response.hidden = false; }
    } catch (error) { tell(error.message); }
    send.disabled = !form;
  };
  const load = () => app.ask('interfaces').then(found => { ({ services, actions } = found); show(); }).catch(() => {});
  let isShown = false;
  for (const event of ['scene', 'link']) app.on(event, () => { if (isShown) load(); });
  return {
    element: element('div', { class: 'call-tab' }, element('div', { class: 'side' }, search, list), middle, element('div', { class: 'call-side' }, element('h4', {}, 'Goals'), calls)),
    show(shown) {
      isShown = shown;
      app.connection.want('calls', shown ? {} : null);
      if (shown) load();
    },
  };
}
