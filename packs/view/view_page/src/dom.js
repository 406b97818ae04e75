// Elements of the page.

/** Returns a new element. `attributes` are properties; `class`, `style` objects and `on…` functions work too. */
export function element(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (key === 'class') made.className = value;
    else if (key.startsWith('on')) made.addEventListener(key.slice(2), value);
    else if (key.includes('-')) made.setAttribute(key, value);
    else made[key] = value;
  }
  made.append(...children.filter(child => child !== null));
  return made;
}

/** Returns a panel with a title that folds. */
export function panel(id, title, ...children) {
  const box = element('details', { class: 'panel', id, open: true }, element('summary', {}, title), ...children);
  const key = `simkit-panel-${id}`;
  try {
    if (localStorage.getItem(key) === 'closed') box.open = false;
    box.addEventListener('toggle', () => localStorage.setItem(key, box.open ? 'open' : 'closed'));
  } catch { /* a page in a notebook may have no storage */ }
  return box;
}

/** Returns a checkbox with its label. */
export function checkbox(id, text, checked, change) {
  const box = element('input', { type: 'checkbox', id, checked, onchange: () => change(box.checked) });
  return element('label', { class: 'check' }, box, text);
}
