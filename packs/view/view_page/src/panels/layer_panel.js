// Panel with a checkbox for each layer.
import { checkbox, element, keepChoice, panel } from '../dom.js';
import { LAYERS } from '../layers.js';
import { QUALITIES } from '../stage.js';

export function makeLayerPanel(app) {
  const boxes = LAYERS.map(([name, title, on]) => checkbox(`show-${name}`, title, on, checked => app.layers.set(name, checked)));
  const choice = element('select', { id: 'quality', title: 'Automatic: full while nothing moves, and fast while something moves on a computer without a graphics card',
    onchange: () => { app.stage.setQuality(choice.value); keepChoice('quality', choice.value); } }, ...Object.entries(QUALITIES).map(([value, text]) => element('option', { value, selected: value === app.stage.quality }, text)));
  const now = element('span', { id: 'quality-now', class: 'dim' });
  app.stage.onQuality.push(isFull => { now.textContent = app.stage.quality === 'auto' ? `now ${isFull ? 'full' : 'fast'}` : ''; });
  choice.addEventListener('change', () => { now.textContent = ''; });
  const quality = element('label', { class: 'check', style: 'margin-top: 8px' }, 'Drawing', choice, now);
  return panel('layers', 'Show', element('div', { class: 'checks' }, ...boxes), quality);
}
