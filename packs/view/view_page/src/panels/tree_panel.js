// Tree of models and links; a click selects.
import { element, panel } from '../dom.js';

export function makeTree(app) {
  const list = element('div', { class: 'tree' });
  const short = name => name.split('::').at(-1);
  const link = name => element('button', { class: 'leaf', title: name, 'data-link': name, onclick: () => app.select(name) }, short(name));
  const model = found => {
    const box = element('details', { class: found.static ? 'static' : '' }, element('summary', { title: found.scoped }, found.name));
    box.addEventListener('toggle', () => { // links are made when they are seen: a hundred robots have thousands
      if (box.open && box.childElementCount === 1) box.append(...found.links.map(link), ...found.models.map(model));
    });
    return box;
  };
  app.on('scene', scene => list.replaceChildren(...scene.models.map(model)));
  app.on('select', name => {
    for (const found of list.querySelectorAll('.leaf')) found.classList.toggle('selected', found.dataset.link === name);
  });
  return panel('tree', 'World', list);
}
