// Copies the next command; where the clipboard is not to be had, it is marked to be copied by hand.
(function () {
  const button = document.getElementById("copy"), text = document.getElementById("next");
  if (!button || !text) return;
  const told = said => { button.textContent = said; };
  const mark = () => {
    const range = document.createRange();
    range.selectNodeContents(text);
    getSelection().removeAllRanges();
    getSelection().addRange(range);
    told(document.execCommand("copy") ? "copied" : "marked: copy it");
  };
  button.onclick = () => {
    if (!navigator.clipboard) return mark();
    navigator.clipboard.writeText(text.textContent).then(() => told("copied"), mark);
  };
})();
