// Before anything is painted: light or dark as the reader chose last. Storage may be forbidden.
'use strict';
try {
  const theme = localStorage.getItem('maup-theme');
  if (theme === 'light' || theme === 'dark') document.documentElement.dataset.theme = theme;
} catch {
  /* the system's choice holds */
}
document.documentElement.classList.add('script');
