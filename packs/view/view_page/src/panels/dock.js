// Area below the scene with tabs: plots, console, services, parameters, motions and graphs. It is closed at first.
import { element } from '../dom.js';
import { makeCallTab } from './call_tab.js';
import { makeConsoleTab } from './console_tab.js';
import { makeFrameTab, makeGraphTab } from './graph_tab.js';
import { makeMotionTab } from './motion_tab.js';
import { makeParameterTab } from './parameter_tab.js';
import { makePlotTab } from './plot_tab.js';

/**
 * Tabs: name, title, function `make(app)`, and true if a recording has it. `make` returns `element` and `show(isShown)`;
 * a tab that is not shown asks the server for nothing.
 */
const TABS = [
  ['plots', 'Plots', makePlotTab, true], ['console', 'Console', makeConsoleTab, true], ['calls', 'Services and actions', makeCallTab, false],
  ['motions', 'Motions', makeMotionTab, false], ['parameters', 'Parameters', makeParameterTab, false],
  ['graph', 'Graph', makeGraphTab, false], ['frames', 'Frames', makeFrameTab, false],
];
const KEY = 'simkit-dock';
const LOWEST = 120;

export function makeDock(app) {
  const body = element('div', { id: 'dock-body' }), grip = element('div', { id: 'dock-grip', title: 'Drag to change the height' });
  const bar = element('div', { id: 'dock-tabs', role: 'tablist' });
  const dock = element('section', { id: 'dock', 'aria-label': 'Data' }, grip, bar, body);
  const made = new Map();
  let shown = null;

  const open = name => {
    if (shown) made.get(shown).show(false);
    shown = name;
    for (const [id, [, button]] of buttons) {
      button.classList.toggle('on', id === name);
      button.setAttribute('aria-selected', id === name);
    }
    document.body.classList.toggle('docked', name !== null);
    if (name && !made.has(name)) made.set(name, TABS.find(([id]) => id === name)[2](app));
    body.replaceChildren(...(name ? [made.get(name).element] : []));
    if (name) made.get(name).show(true);
    keep();
  };
  const buttons = new Map(TABS.map(tab => [tab[0], [tab, element('button', { id: `tab-${tab[0]}`, role: 'tab', onclick: () => open(shown === tab[0] ? null : tab[0]) }, tab[1])]]));
  const close = element('button', { id: 'dock-close', title: 'Close', 'aria-label': 'Close', onclick: () => open(null) }, '✕');
  bar.append(...[...buttons.values()].map(([, button]) => button), element('span', { class: 'space' }), close);

  const keep = () => {
    try { localStorage.setItem(KEY, JSON.stringify([shown, body.style.height])); } catch { /* a page in a notebook may have no storage */ }
  };
  const setHeight = height => { body.style.height = `${Math.round(Math.min(Math.max(height, LOWEST), innerHeight * 0.75))}px`; };
  grip.addEventListener('pointerdown', event => {
    grip.setPointerCapture(event.pointerId);
    const from = event.clientY, before = body.clientHeight;
    const move = moved => setHeight(before + from - moved.clientY);
    const end = () => { grip.removeEventListener('pointermove', move); keep(); };
    grip.addEventListener('pointermove', move);
    grip.addEventListener('lostpointercapture', end, { once: true });
  });
  app.on('scene', scene => { for (const [tab, button] of buttons.values()) button.hidden = scene.recording && !tab[3]; });
  app.openTab = open;
  document.body.append(dock);
  try {
    const [name, height] = JSON.parse(localStorage.getItem(KEY)) ?? [];
    if (height) setHeight(parseFloat(height));
    if (buttons.has(name)) app.on('scene', scene => { if (shown === null && !made.size && !(scene.recording && !buttons.get(name)[0][3])) open(name); });
  } catch { /* as above */ }
  return null;
}
