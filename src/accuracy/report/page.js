const body = document.querySelector("#levels tbody");
const headings = [...document.querySelectorAll("#levels th")];
const value = (row, column) => {
  const cell = row.children[column];
  if (!cell) return null;
  return "key" in cell.dataset ? Number(cell.dataset.key) : cell.textContent.trim() || null;
};
headings.forEach((heading, column) => heading.addEventListener("click", () => {
  const falling = heading.getAttribute("aria-sort") === "ascending";
  headings.forEach(other => other.removeAttribute("aria-sort"));
  heading.setAttribute("aria-sort", falling ? "descending" : "ascending");
  const order = (a, b) => typeof a === "number" && typeof b === "number" ? a - b : String(a).localeCompare(String(b));
  const rows = [...body.rows].map(row => [value(row, column), row]);
  // Rows without the number stay last, whichever way the others are sorted.
  const missing = v => v === null || v === "-";
  rows.sort(([a], [b]) => missing(a) || missing(b) ? missing(a) - missing(b) : falling ? order(b, a) : order(a, b));
  body.append(...rows.map(([, row]) => row));
}));
document.querySelector("#filter").addEventListener("input", event => {
  const words = event.target.value.toLowerCase().split(/\s+/);
  for (const row of body.rows) row.hidden = !words.every(word => row.textContent.toLowerCase().includes(word));
});
