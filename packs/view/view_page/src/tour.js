// Tour of the page: up to six steps, each with the outline of a part of the page. It begins by itself at the first visit.
import { element, keepChoice, keptChoice, narrow } from './dom.js';

/** Steps: selectors of the part, of which the first that is shown counts, heading and text. */
const STEPS = [
  ['#view', 'The scene', 'Drag to turn the view, drag with the right button or two fingers to move it, and use the wheel or two fingers to zoom. Click a link to select it.'],
  ['#toolbar .group', 'Run, step and reset', 'Pause and resume (space), make steps (n), or start again. The list beside the buttons limits the speed.'],
  ['#tree', 'Models and links', 'Select a model or a link here. The panel Models adds a model to the world, and moves, turns or deletes the selected one.'],
  ['#layers', 'What is drawn', 'Show lidars, contacts, frames, joint axes, centres of mass and more. Topics such as paths and maps have a list of their own.'],
  ['#drive, #joints', 'Move the robot', 'Drive with the pad or with the keys w a s d x. Sliders move the joints while the world is paused.'],
  ['#dock-tabs', 'Data', 'Plot any field of any topic, read the log, call services, send goals, set parameters, and draw the graph of nodes.'],
];

export function makeTour(app) {
  const title = element('h3'), text = element('p'), number = element('span', { class: 'dim' });
  const button = (id, name, onclick) => element('button', { id, onclick }, name);
  const back = button('tour-back', 'Back', () => go(-1)), next = button('tour-next', 'Next', () => go(1));
  const box = element('section', { id: 'tour', role: 'dialog', 'aria-label': 'Tour of the page', hidden: true }, title, text,
    element('footer', {}, number, button('tour-skip', 'Skip', () => end()), back, next));
  let steps = [], at = 0, target = null, wasOpen = true;

  const partOf = ([selector]) => [...document.querySelectorAll(selector)].find(part => part.getClientRects().length);
  const leave = () => {
    if (!target) return;
    target.classList.remove('toured');
    if (!wasOpen) target.open = false;
    target = null;
  };
  const go = by => {
    if (at + by === steps.length) { end(); return; }
    leave();
    at += by;
    const [, heading, words] = steps[at];
    target = partOf(steps[at]);
    wasOpen = target.open !== false;
    if (!wasOpen) target.open = true;
    target.classList.add('toured');
    target.scrollIntoView({ block: 'nearest' });
    title.textContent = heading;
    text.textContent = words;
    number.textContent = `${at + 1} of ${steps.length}`;
    next.textContent = at + 1 === steps.length ? 'Done' : 'Next';
    back.disabled = at === 0;
    box.className = sideOf(target);
  };
  /** Returns the side of the scene that is next to a part of the page. */
  const sideOf = part => {
    const there = part.getBoundingClientRect(), view = document.getElementById('view').getBoundingClientRect();
    if (there.right <= view.left) return 'left';
    if (there.left >= view.right) return 'right';
    return there.bottom <= view.top ? 'above' : 'below';
  };
  const start = () => {
    if (narrow.matches) app.openTab(null); // an open tab hides the panels
    leave();
    steps = STEPS.filter(partOf);
    box.hidden = false;
    at = 0;
    go(0);
  };
  const end = () => {
    leave();
    box.hidden = true;
    keepChoice('tour', 'off');
  };

  addEventListener('keydown', event => { if (event.key === 'Escape' && !box.hidden) end(); });
  document.getElementById('view').append(box);
  app.tour = { start };
  let isFirst = true;
  app.on('state', () => { // the panels know then what they can show
    const isOwn = isFirst && !app.player && window.top === window;
    isFirst = false;
    if (isOwn && keptChoice('tour') !== 'off') app.ask('targets').finally(start);
  });
}
