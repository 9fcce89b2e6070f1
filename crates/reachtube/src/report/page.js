"use strict";
(() => {
  const root = document.documentElement;
  const all = (selector, within = document) => [...within.querySelectorAll(selector)];
  root.classList.add("js");

  // One of several panes at a time, chosen by a row of buttons.
  const choice = (id, key) => {
    const group = document.getElementById(id);
    if (!group) return;
    const buttons = all("button", group);
    const show = value => {
      buttons.forEach(button => button.setAttribute("aria-pressed", String(button.value === value)));
      all(`[data-${key}]`).forEach(pane => { pane.hidden = pane.dataset[key] !== value; });
    };
    buttons.forEach(button => button.addEventListener("click", () => show(button.value)));
    group.hidden = false;
    show(buttons[0].value);
  };
  choice("suites", "suite");
  choice("views", "view");

  // A run is singled out by dimming the lines of the others of its suite.
  const sheet = document.head.appendChild(document.createElement("style"));
  let pinned = null;
  const single = chip => {
    all(".runs .seen").forEach(other => other.classList.remove("seen"));
    sheet.textContent = "";
    if (!chip) return;
    const suite = chip.closest(".suite");
    const line = stroke => `#${suite.id} polyline[stroke="${stroke}"]`;
    const stroke = chip.dataset.stroke;
    const others = all(".runs button", suite).map(other => other.dataset.stroke).filter(other => other !== stroke);
    const dim = others.length ? `${others.map(line).join()} { opacity: .1; }` : "";
    sheet.textContent = `${dim} ${line(stroke)} { stroke-width: 13; }`;
    chip.classList.add("seen");
  };
  const pin = chip => {
    if (pinned) pinned.setAttribute("aria-pressed", "false");
    pinned = pinned === chip ? null : chip;
    if (pinned) pinned.setAttribute("aria-pressed", "true");
    single(pinned);
  };
  all(".suite").forEach(suite => {
    const chips = new Map(all(".runs button", suite).map(chip => [chip.dataset.stroke, chip]));
    const owner = event => event.target.closest(".runs button")
      || (event.target.localName === "polyline" && chips.get(event.target.getAttribute("stroke")));
    suite.addEventListener("pointerover", event => single(owner(event) || pinned));
    suite.addEventListener("pointerleave", () => single(pinned));
    suite.addEventListener("click", event => { const chip = owner(event); if (chip) pin(chip); });
  });

  root.dataset.ready = "yes";
})();
