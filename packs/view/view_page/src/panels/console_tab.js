// Console: diagnostics of the load and log messages of plugins, with filters by level, node and text.
import { element } from '../dom.js';
import { filePackets } from './series_store.js';

const LEVELS = [['debug', 10], ['info', 20], ['warn', 30], ['error', 40], ['fatal', 50]];
const MOST = 2000; // kept messages
const MOST_SHOWN = 500;

export function makeConsoleTab(app) {
  let entries = [], source = null, last = 0, isAsking = false, isShown = false, newest = 0;
  const level = element('select', { id: 'log-level', title: 'Lowest level', onchange: () => show() }, ...LEVELS.map(([name]) => element('option', { value: name }, name)));
  level.selectedIndex = 1;
  const node = element('input', { id: 'log-node', type: 'search', placeholder: 'Node', oninput: () => show() });
  const text = element('input', { id: 'log-text', type: 'search', placeholder: 'Text', oninput: () => show() });
  const count = element('span', { id: 'log-count', class: 'dim' });
  const follow = element('input', { type: 'checkbox', id: 'log-follow', checked: true, onchange: () => show() });
  const rows = element('div', { id: 'log-rows', role: 'log' });
  const bar = element('div', { class: 'tab-tools' }, level, node, text, element('label', { class: 'check' }, follow, 'Follow'),
    element('button', { id: 'log-clear', onclick: () => { entries = []; show(); } }, 'Clear'), count);

  const isWanted = entry => entry.level >= LEVELS[level.selectedIndex][1] && entry.node.toLowerCase().includes(node.value.trim().toLowerCase()) && entry.text.toLowerCase().includes(text.value.trim().toLowerCase());
  const row = entry => {
    const name = LEVELS.findLast(([, least]) => entry.level >= least)?.[0] ?? 'debug';
    return element('div', { class: `log ${name}`, title: entry.place }, element('span', { class: 'time' }, entry.time.toFixed(3)),
      element('span', { class: 'level' }, name), element('span', { class: 'node' }, entry.node), element('span', { class: 'text' }, entry.text));
  };
  const note = found => { count.textContent = `${found.length} of ${entries.length} messages`; };
  const show = () => {
    const found = entries.filter(isWanted);
    rows.replaceChildren(...found.slice(-MOST_SHOWN).map(row));
    note(found);
    if (follow.checked) rows.scrollTop = rows.scrollHeight;
  };
  const append = fresh => {
    entries.push(...fresh);
    if (entries.length > MOST) entries.splice(0, entries.length - MOST);
    rows.append(...fresh.filter(isWanted).map(row));
    while (rows.childElementCount > MOST_SHOWN) rows.firstChild.remove();
    note(entries.filter(isWanted));
    if (follow.checked) rows.scrollTop = rows.scrollHeight;
  };
  const ask = async () => {
    if (isAsking) return;
    isAsking = true;
    try {
      while (isShown && last < newest) {
        const fresh = await app.ask('log', { after: last });
        if (!fresh.length) break;
        last = fresh.at(-1).number;
        append(fresh);
      }
    } catch { /* the connection has ended; the next packet asks again */ }
    isAsking = false;
  };
  app.on('packet:log', packet => {
    if (packet.source !== source) { entries = []; last = 0; source = packet.source; show(); }
    newest = packet.last;
    ask();
  });
  app.console = { get entries() { return entries; } };
  const file = filePackets();
  if (file) append(file.get('log')?.entries ?? []);
  return {
    element: element('div', { class: 'console-tab' }, bar, rows),
    show(shown) {
      isShown = shown;
      app.connection.want('log', shown ? {} : null);
    },
  };
}
