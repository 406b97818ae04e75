// Goals and calls that pages have sent, with feedback, result and a button to cancel.
import { element } from '../dom.js';

export function makeCallList(app) {
  const list = element('div', { class: 'calls' });
  const rows = new Map();
  const make = call => {
    const status = element('span', { class: 'status' }), text = element('pre', {}), cancel = element('button', { onclick: () => app.send('cancel', { goal: call.id }) }, 'Cancel');
    const box = element('div', { class: 'call', 'data-call': call.id }, element('div', { class: 'call-head' }, element('span', { class: 'name', title: call.name }, element('bdi', {}, call.name)), status, cancel), text);
    list.prepend(box);
    return { box, status, text, cancel };
  };
  app.on('packet:calls', ({ calls }) => {
    for (const call of calls) {
      if (!rows.has(call.id)) rows.set(call.id, make(call));
      const { box, status, text, cancel } = rows.get(call.id);
      status.textContent = call.status.toLowerCase();
      box.className = `call ${call.status.toLowerCase()}`;
      cancel.hidden = call.done || call.kind !== 'goal';
      const shown = [call.reason, call.text && `${call.kind === 'goal' ? (call.is_result ? 'result' : 'feedback') : 'response'}:\n${call.text}`].filter(Boolean).join('\n');
      if (text.textContent !== shown) text.textContent = shown;
      text.hidden = !shown;
    }
    for (const [id, { box }] of rows) if (!calls.some(call => call.id === id)) { box.remove(); rows.delete(id); }
  });
  return list;
}
