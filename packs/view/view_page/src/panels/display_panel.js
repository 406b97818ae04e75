// Topics that can be drawn in the scene, each with a checkbox, its type, and what of its messages cannot be drawn.
import { checkbox, element, panel } from '../dom.js';
import { MarkerHandles } from '../marker_handles.js';

export function makeDisplayPanel(app) {
  const list = element('div', { class: 'displays' });
  const box = panel('displays', 'Topics in the scene', list);
  const rows = new Map(), handles = app.markerHandles = new MarkerHandles(app);
  const makeRow = (topic, type) => {
    const check = checkbox(`display-${topic}`, topic, app.displays.wanted.has(topic), on => app.displays.set(topic, on));
    check.title = type;
    const problems = element('div', { class: 'dim problem' });
    const markers = element('div', { class: 'markers' });
    return { type, check, problems, markers, shown: '', element: element('div', {}, check, problems, markers) };
  };
  const showMarkers = (topic, row) => { // only if they have changed: a menu that is open stays
    const found = app.player ? [] : app.displays.handles(topic);
    const shown = JSON.stringify(found.map(({ name, description, move, turn, button, menu }) => [name, description, move, turn, button, menu]));
    if (shown === row.shown) return;
    row.shown = shown;
    row.markers.replaceChildren(...found.map(handle => handles.row(handle)));
  };
  const show = () => {
    const { topics } = app.displays, names = new Set(topics.map(([topic]) => topic));
    for (const topic of rows.keys()) if (!names.has(topic) && !app.displays.wanted.has(topic)) rows.delete(topic);
    for (const [topic, type] of topics) if (rows.get(topic)?.type !== type) rows.set(topic, makeRow(topic, type));
    for (const [topic, row] of rows) {
      row.problems.textContent = app.displays.problems(topic).join('; ');
      showMarkers(topic, row);
    }
    const elements = [...rows].sort(([a], [b]) => (a < b ? -1 : 1)).map(([, row]) => row.element);
    if (elements.length !== list.children.length || elements.some((found, i) => found !== list.children[i])) list.replaceChildren(...elements);
    box.hidden = rows.size === 0;
  };
  app.on('displays', show);
  app.on('scene', () => { if (!app.player) app.connection.want('displays', {}); });
  app.on('recording', player => { app.displays.topics = player.displayTopics(); show(); });
  box.hidden = true;
  return box;
}
