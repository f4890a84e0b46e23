// How tests start Chromium. Its own requests (updates, sync) are no business of a test, and machines of tests have
// neither a graphics card nor much shared memory.
export const flags = [
  '--no-sandbox',
  '--disable-gpu',
  '--disable-dev-shm-usage',
  '--disable-background-networking',
  '--disable-component-update',
  '--disable-sync',
  '--no-first-run',
];
