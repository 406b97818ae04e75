// Tree of models and links; a click selects. A click on the name of a model also flies to it.
import { element, panel } from '../dom.js';

export function makeTree(app) {
  const list = element('div', { class: 'tree' });
  const short = name => name.split('::').at(-1);
  const link = name => element('button', { class: 'leaf', title: name, 'data-link': name, onclick: () => app.select(name) }, short(name));
  const model = found => {
    const name = element('button', { class: 'model', 'data-model': found.scoped, onclick: event => {
      event.preventDefault(); // the triangle opens and closes
      box.open = true;
      app.select(found.scoped);
      app.views.flyTo(found.scoped);
    } }, found.name);
    const box = element('details', { class: found.static ? 'static' : '' }, element('summary', { title: found.scoped }, name));
    box.addEventListener('toggle', () => { // links are made when they are seen: a hundred robots have thousands
      if (box.open && box.childElementCount === 1) box.append(...found.links.map(link), ...found.models.map(model));
    });
    return box;
  };
  app.on('scene', scene => list.replaceChildren(...scene.models.map(model)));
  app.on('select', name => {
    for (const found of list.querySelectorAll('.leaf, .model')) found.classList.toggle('selected', (found.dataset.link ?? found.dataset.model) === name);
  });
  return panel('tree', 'World', list);
}
