"use strict";
(() => {
  const root = document.documentElement;
  const all = (selector, within = document) => [...within.querySelectorAll(selector)];
  root.classList.add("js");

  // Shows one of several panes at a time, chosen by a row of buttons.
  const choice = (id, key) => {
    const group = document.getElementById(id);
    if (!group) return;
    const buttons = all("button", group);
    const show = value => {
      buttons.forEach(button => {
        button.setAttribute("aria-pressed", String(button.value === value));
      });
      all(`[data-${key}]`).forEach(pane => { pane.hidden = pane.dataset[key] !== value; });
    };
    buttons.forEach(button => button.addEventListener("click", () => show(button.value)));
    group.hidden = false;
    show(buttons[0].value);
  };
  choice("suites", "suite");
  choice("views", "view");

  // Highlights a run by dimming the lines of the other runs of its suite.
  const sheet = document.head.appendChild(document.createElement("style"));
  let pinned = null;
  const highlight = chip => {
    all(".runs .lit").forEach(other => other.classList.remove("lit"));
    sheet.textContent = "";
    if (!chip) return;
    const suite = chip.closest(".suite");
    const line = stroke => `#${suite.id} polyline[stroke="${stroke}"]`;
    const stroke = chip.dataset.stroke;
    const strokes = all(".runs button", suite).map(other => other.dataset.stroke);
    const others = strokes.filter(other => other !== stroke);
    const dim = others.length ? `${others.map(line).join()} { opacity: .1; }` : "";
    sheet.textContent = `${dim} ${line(stroke)} { stroke-width: 13; }`;
    chip.classList.add("lit");
  };
  // Keeps a run highlighted until it is chosen again.
  const pin = chip => {
    if (pinned) pinned.setAttribute("aria-pressed", "false");
    pinned = pinned === chip ? null : chip;
    if (pinned) pinned.setAttribute("aria-pressed", "true");
    highlight(pinned);
  };
  all(".suite").forEach(suite => {
    const chips = new Map(all(".runs button", suite).map(chip => [chip.dataset.stroke, chip]));
    const owner = event => event.target.closest(".runs button")
      || (event.target.localName === "polyline" && chips.get(event.target.getAttribute("stroke")));
    suite.addEventListener("pointerover", event => highlight(owner(event) || pinned));
    suite.addEventListener("pointerleave", () => highlight(pinned));
    suite.addEventListener("click", event => { const chip = owner(event); if (chip) pin(chip); });
  });

  root.dataset.ready = "yes";
})();
