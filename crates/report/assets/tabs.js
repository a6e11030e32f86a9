// Tabs by the ARIA practice: arrows, Home and End move and choose. The chosen tab stays when the scenario changes.

let chosenTab = 'story';

const tabName = (tab) => tab.id.split('--').pop().replace(/-tab$/, '');

/** Shows one tab of a scenario's section; the first, where it has none of that name. */
function chooseTab(section, name) {
  const tabs = all('[role=tab]', section);
  const chosen = tabs.find((tab) => tabName(tab) === name) ?? tabs[0];
  for (const tab of tabs) {
    const on = tab === chosen;
    tab.setAttribute('aria-selected', on);
    tab.tabIndex = on ? 0 : -1;
    document.getElementById(tab.getAttribute('aria-controls')).hidden = !on;
  }
  if (chosen && tabName(chosen) === 'tuning') drawTuning(section);
  return chosen;
}

function setUpTabs(section) {
  const tabs = all('[role=tab]', section);
  const choose = (tab) => {
    chosenTab = tabName(tab);
    chooseTab(section, chosenTab);
    rememberPlace(section);
  };
  for (const tab of tabs) {
    tab.addEventListener('click', () => choose(tab));
    tab.addEventListener('keydown', (event) => {
      const at = tabs.indexOf(tab);
      const to = { ArrowRight: at + 1, ArrowLeft: at - 1, Home: 0, End: tabs.length - 1 }[event.key];
      if (to === undefined) return;
      event.preventDefault();
      event.stopPropagation();
      const next = tabs[(to + tabs.length) % tabs.length];
      choose(next);
      next.focus();
    });
  }
}
