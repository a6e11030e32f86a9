// The page of runs side by side: every pair with a replay of its own, made when it comes into sight.

const rawCase = (position) => readBlock(`case-data-${position}`);
readColours();
nameCells(document);
const replays = new Map();
const observer = new IntersectionObserver((entries) => {
  for (const { target, isIntersecting } of entries) {
    if (!isIntersecting || replays.has(target)) continue;
    const replay = new Replay(target);
    replays.set(target, replay);
    replay.ghosts = true;
    replay.show('both');
    replay.plots.forEach((plot) => plot.draw());
  }
}, { rootMargin: '300px' });
all('section.case').forEach((section) => observer.observe(section));
all('[data-copy]').forEach((button) => button.addEventListener('click', () => {
  navigator.clipboard?.writeText(one('code', button.parentElement).textContent).then(() => tell('Copied'));
}));
// Keys go to the replay they are pressed in.
addEventListener('keydown', (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey || !event.target.matches('.views')) return;
  const replay = replays.get(event.target.closest('section.case'));
  if (replay && replayKey(replay, event)) event.preventDefault();
});
matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => {
  readColours();
  replays.forEach((replay) => replay.draw());
});
