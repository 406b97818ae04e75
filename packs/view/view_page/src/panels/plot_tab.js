// Tab with the list of topics and the plots.
import { element } from '../dom.js';
import { Plot } from './plot.js';
import { SeriesStore } from './series_store.js';
import { TopicList } from './topic_list.js';

const REDRAW = 100; // [ms] at least between two drawings

export function makePlotTab(app) {
  const store = new SeriesStore(app), area = element('div', { class: 'plots' });
  let plots = [], chosen = null, isShown = false, timer = null;

  const select = plot => {
    chosen = plot;
    for (const one of plots) one.element.classList.toggle('chosen', one === plot && plots.length > 1);
  };
  const close = plot => {
    plot.close();
    plot.element.remove();
    plots = plots.filter(one => one !== plot);
    select(plots.at(-1) ?? null);
    keep();
  };
  const add = () => {
    const plot = new Plot(app, store, { close, select, changed: keep });
    plots.push(plot);
    area.append(plot.element);
    select(plot);
    return plot;
  };
  const key = () => `simkit-plots ${app.scene?.world}`;
  const keep = () => {
    try { localStorage.setItem(key(), JSON.stringify(plots.map(plot => plot.fields))); } catch { /* a page in a notebook may have no storage */ }
  };
  const restore = () => {
    try { for (const fields of JSON.parse(localStorage.getItem(key())) ?? []) { const plot = add(); for (const { topic, field } of fields) plot.add(topic, field); } } catch { /* as above */ }
    if (!plots.length) add();
  };
  const choose = (topic, field) => (chosen ?? add()).add(topic, field);
  const draw = () => {
    if (timer !== null || !isShown) return;
    timer = setTimeout(() => {
      timer = null;
      if (isShown && !document.hidden) for (const plot of plots) plot.draw();
    }, REDRAW);
  };
  store.listeners.push(draw);
  const list = new TopicList(app, store, choose);
  list.element.append(element('button', { id: 'new-plot', onclick: add }, '+ Plot'));
  app.on('state', () => { if (app.player) draw(); });
  app.on('scene', () => { if (isShown) store.want(); });
  matchMedia('(prefers-color-scheme: light)').addEventListener('change', draw);
  app.plots = { store, list, add, choose, get all() { return plots; } };
  restore();
  return {
    element: element('div', { class: 'plot-tab' }, list.element, area),
    show(shown) {
      isShown = shown;
      list.setShown(shown);
      store.show(shown);
      if (shown) for (const plot of plots) plot.draw();
    },
  };
}
