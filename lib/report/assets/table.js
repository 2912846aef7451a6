// The head of a column sorts the table by it, by click or key; again it turns the order round. The filter
// leaves the rows that have, for each of its words, a word that begins so: "complete" is not "incomplete".
for (const table of document.querySelectorAll("table.sortable")) {
  const body = table.tBodies[0], heads = [...table.tHead.rows[0].cells];
  heads.forEach((head, column) => {
    const button = document.createElement("button");
    button.append(...head.childNodes);
    head.append(button);
    button.addEventListener("click", () => {
      const down = head.getAttribute("aria-sort") !== "descending";
      for (const other of heads) other.removeAttribute("aria-sort");
      head.setAttribute("aria-sort", down ? "descending" : "ascending");
      const text = (row) => row.cells[column].textContent;
      const order = head.classList.contains("n")
        ? (a, b) => (parseFloat(text(b)) || 0) - (parseFloat(text(a)) || 0)
        : (a, b) => text(a).localeCompare(text(b));
      const rows = [...body.rows].sort(order);
      if (!down) rows.reverse();
      body.append(...rows);
    });
  });
  const filter = document.getElementById("filter"), count = document.getElementById("count");
  filter.addEventListener("input", () => {
    const words = filter.value.toLowerCase().split(/\s+/).filter(Boolean).map(
      w => new RegExp("(?<![\\p{L}\\p{N}])" + w.replace(/[.*+?^${}()|[\]\\]/g, "\\$&"), "u"));
    let shown = 0;
    for (const row of body.rows) {
      const text = [...row.cells].map(cell => cell.textContent).join(" ").toLowerCase();
      row.hidden = !words.every(w => w.test(text));
      shown += !row.hidden;
    }
    count.textContent = shown + " of " + body.rows.length;
  });
}
