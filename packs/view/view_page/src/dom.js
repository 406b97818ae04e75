// Elements of the page.

/** Returns a number with a count of decimals, without a minus sign before zero. */
export const fixed = (value, digits) => value.toFixed(digits).replace(/^-(0(\.0*)?)$/, '$1');

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

/** Matches a narrow window, such as that of a phone, whose panels lie below the scene. */
export const narrow = matchMedia('(max-width: 900px)');

/** Returns a panel with a title that folds. In a narrow window, only driving and the selection are open at first. */
export function panel(id, title, ...children) {
  const box = element('details', { class: 'panel', id, open: !narrow.matches || ['drive', 'selection'].includes(id) }, element('summary', {}, title), ...children);
  const key = `simkit-${narrow.matches ? 'phone' : 'panel'}-${id}`;
  try {
    const kept = localStorage.getItem(key);
    if (kept) box.open = kept === 'open';
    box.addEventListener('toggle', () => localStorage.setItem(key, box.open ? 'open' : 'closed'));
  } catch { /* a page in a notebook may have no storage */ }
  return box;
}

/** Returns a checkbox with its label. */
export function checkbox(id, text, checked, change) {
  const box = element('input', { type: 'checkbox', id, checked, onchange: () => change(box.checked) });
  return element('label', { class: 'check' }, box, text);
}

/** Returns true if a key is one of the page: not of the browser, and not of the field that has the focus. */
export function isPageKey(event) {
  const field = event.target.closest('input, select, textarea');
  return !(event.ctrlKey || event.metaKey || event.altKey) && (!field || (field.type === 'checkbox' && event.key !== ' '));
}

/** Stores a choice of the user in a cookie, which holds on every port: each run has its own. */
export function keepChoice(name, value) {
  try { document.cookie = `simkit-${name}=${value}; max-age=31536000; samesite=strict; path=/`; } catch { /* a page in a notebook may have no cookies */ }
}

export function keptChoice(name) {
  try { return document.cookie.match(new RegExp(`(?:^|; )simkit-${name}=(\\w+)`))?.[1]; } catch { return undefined; /* as above */ }
}
