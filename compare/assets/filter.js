// The table of checks: only the rows whose text holds what is typed, and whose outcome is the one chosen.
"use strict";
(() => {
  const table = document.getElementById("check-rows");
  if (!table) return;
  const words = document.getElementById("filter-words");
  const outcome = document.getElementById("filter-outcome");
  const count = document.getElementById("filter-count");
  const rows = [...table.querySelectorAll("tr[data-outcome]")];

  const lower = (node) => node.textContent.toLowerCase();
  function filter() {
    const wanted = words.value.toLowerCase().split(/\s+/).filter(Boolean);
    for (const row of rows) {
      const text = lower(row.closest("tbody").rows[0]) + lower(row.cells[0]);
      row.hidden = (outcome.value && row.dataset.outcome !== outcome.value) || !wanted.every((word) => text.includes(word));
      const why = row.nextElementSibling;
      if (why?.classList.contains("why")) why.hidden = row.hidden;
    }
    for (const block of table.tBodies) block.hidden = rows.every((row) => row.closest("tbody") !== block || row.hidden);
    count.textContent = `${rows.filter((row) => !row.hidden).length} of ${rows.length}`;
  }
  document.getElementById("filter").hidden = false;
  words.addEventListener("input", filter);
  outcome.addEventListener("change", filter);
  filter();
})();
