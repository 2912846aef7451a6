// A click on the head of a column sorts the table by it; a second click turns the order round.
for (const table of document.querySelectorAll("table.sortable")) {
  const body = table.tBodies[0];
  [...table.tHead.rows[0].cells].forEach((head, column) => {
    head.style.cursor = "pointer";
    head.addEventListener("click", () => {
      const down = head.dataset.down !== "1";
      head.dataset.down = down ? "1" : "";
      const text = (row) => row.cells[column].textContent;
      const order = head.classList.contains("n")
        ? (a, b) => (parseFloat(text(b)) || 0) - (parseFloat(text(a)) || 0)
        : (a, b) => text(a).localeCompare(text(b));
      const rows = [...body.rows].sort(order);
      if (!down) rows.reverse();
      body.append(...rows);
    });
  });
}
