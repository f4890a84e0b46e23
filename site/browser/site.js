// What every page does: light and dark, the lists on small screens, search, keyboard access to what scrolls.
import MiniSearch from 'minisearch';

const root = document.documentElement,
  siteRoot = document.body.dataset.root;

function theme() {
  const button = document.getElementById('theme'),
    system = matchMedia('(prefers-color-scheme: dark)');
  const dark = () => (root.dataset.theme ? root.dataset.theme === 'dark' : system.matches);
  const name = () => button.setAttribute('aria-label', dark() ? 'Light page' : 'Dark page');
  const repaint = () => document.dispatchEvent(new Event('maup-theme'));
  button.addEventListener('click', () => {
    root.dataset.theme = dark() ? 'light' : 'dark';
    try {
      localStorage.setItem('maup-theme', root.dataset.theme);
    } catch {
      /* for this page alone */
    }
    name();
    repaint();
  });
  name();
  let chosen;
  addEventListener('beforeprint', () => {
    chosen = root.dataset.theme;
    root.dataset.theme = 'light';
    repaint();
  });
  addEventListener('afterprint', () => {
    if (chosen) root.dataset.theme = chosen;
    else delete root.dataset.theme;
    repaint();
  });
}

// Lists of pages are open where there is room beside the text, and closed above it.
function lists() {
  const narrow = matchMedia('(max-width: 72rem)');
  const fold = () => {
    for (const details of document.querySelectorAll('nav.pages details, nav.contents details'))
      details.open = !narrow.matches;
  };
  narrow.addEventListener('change', fold);
  fold();
  document.querySelector('nav.pages [aria-current]')?.scrollIntoView({block: 'nearest'});
  scrollTo(0, location.hash ? scrollY : 0);
}

// What is wider than its place can be scrolled with the keyboard.
function scrollers() {
  const mark = () => {
    for (const element of document.querySelectorAll('.scroll, .formula, pre')) {
      const scrolls = element.scrollWidth > element.clientWidth + 1;
      if (scrolls) element.tabIndex = 0;
      else element.removeAttribute('tabindex');
    }
  };
  addEventListener('resize', mark);
  document.fonts?.ready.then(mark);
  mark();
}

// ------------------------------------------------------------------------------------------------------------- search

let index = null;

// The texts come by a script of their own, since a page from a file may not fetch; they come when they are asked for.
function load() {
  return (index ??= new Promise((done, failed) => {
    const script = document.createElement('script');
    script.src = `${siteRoot}assets/search.js`;
    script.onload = () => {
      const search = new MiniSearch({
        fields: ['title', 'page', 'text'],
        storeFields: ['title', 'page', 'path', 'kind'],
        searchOptions: {
          boost: {title: 4, page: 2},
          prefix: true,
          fuzzy: term => (term.length > 4 ? 0.15 : false),
          combineWith: 'AND',
          boostDocument: (id, term, {kind, page}) =>
            page === 'Changelog' ? 0.4 : kind === 'reference case' ? 0.7 : 1,
        },
      });
      search.addAll(
        self.maupSearch.map(([kind, page, path, title, text], id) => ({id, kind, page, path, title, text})),
      );
      done(search);
    };
    script.onerror = () => failed(new Error('the texts to search did not load'));
    document.head.append(script);
  }));
}

function search() {
  const field = document.getElementById('search'),
    list = document.getElementById('found');
  let chosen = -1,
    asked = 0;
  const close = () => {
    list.hidden = true;
    field.setAttribute('aria-expanded', 'false');
    field.removeAttribute('aria-activedescendant');
    chosen = -1;
  };
  const choose = to => {
    const items = [...list.querySelectorAll('[role=option]')];
    if (items.length === 0) return;
    chosen = (to + items.length) % items.length;
    items.forEach((item, i) => item.setAttribute('aria-selected', String(i === chosen)));
    items[chosen].scrollIntoView({block: 'nearest'});
    field.setAttribute('aria-activedescendant', items[chosen].id);
  };
  const show = results => {
    list.replaceChildren(
      ...results.slice(0, 12).map((result, i) => {
        const item = document.createElement('li'),
          title = document.createElement('b'),
          place = document.createElement('small');
        item.id = `found-${i}`;
        item.setAttribute('role', 'option');
        item.setAttribute('aria-selected', 'false');
        title.textContent = result.title;
        place.textContent = result.title === result.page ? result.kind : `${result.kind} · ${result.page}`;
        item.append(title, place);
        item.addEventListener('mousedown', event => {
          event.preventDefault();
          location.href = siteRoot + result.path;
        });
        return item;
      }),
    );
    if (results.length === 0) {
      const item = document.createElement('li');
      item.className = 'none';
      item.setAttribute('role', 'option');
      item.setAttribute('aria-selected', 'false');
      item.setAttribute('aria-disabled', 'true');
      item.textContent = 'Nothing found.';
      list.append(item);
    }
    list.hidden = false;
    field.setAttribute('aria-expanded', 'true');
    chosen = -1;
    self.maupFound = results;
  };
  const ask = async () => {
    const text = field.value.trim(),
      mine = ++asked;
    if (text === '') return close();
    const found = (await load()).search(text);
    if (mine === asked) show(found);
  };
  field.addEventListener('focus', () => load());
  field.addEventListener('input', ask);
  field.addEventListener('blur', close);
  field.addEventListener('keydown', event => {
    if (event.key === 'ArrowDown' || event.key === 'ArrowUp') {
      event.preventDefault();
      choose(chosen + (event.key === 'ArrowDown' ? 1 : chosen < 0 ? 0 : -1));
    }
    if (event.key === 'Escape') {
      field.value = '';
      close();
    }
    if (event.key === 'Enter' && !list.hidden && self.maupFound?.length)
      location.href = siteRoot + self.maupFound[Math.max(0, chosen)].path;
  });
  document.addEventListener('keydown', event => {
    if (
      event.key !== '/' ||
      event.ctrlKey ||
      event.metaKey ||
      event.altKey ||
      /^(INPUT|TEXTAREA|SELECT)$/.test(document.activeElement.tagName)
    )
      return;
    event.preventDefault();
    field.focus();
  });
}

// The gallery shows what its filter names.
function filter() {
  const field = document.getElementById('filter');
  if (!field) return;
  const cards = [...document.querySelectorAll('[data-words]')],
    count = document.getElementById('filter-count');
  field.addEventListener('input', () => {
    const words = field.value.toLowerCase().split(/\s+/).filter(Boolean);
    let shown = 0;
    for (const card of cards) {
      card.hidden = !words.every(word => card.dataset.words.includes(word));
      shown += !card.hidden;
    }
    for (const group of document.querySelectorAll('[data-group]'))
      group.hidden = !group.querySelector('[data-words]:not([hidden])');
    count.textContent = words.length ? `${shown} of ${cards.length}` : '';
  });
}

theme();
lists();
scrollers();
search();
filter();
