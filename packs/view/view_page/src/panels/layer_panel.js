// Panel with a checkbox for each layer.
import { checkbox, element, panel } from '../dom.js';
import { LAYERS } from '../layers.js';

export function makeLayerPanel(app) {
  const boxes = LAYERS.map(([name, title, on]) => checkbox(`show-${name}`, title, on && !(name === 'shadows' && app.stage.lite), checked => app.layers.set(name, checked)));
  return panel('layers', 'Show', element('div', { class: 'checks' }, ...boxes));
}
