/** An action: the first field of a form has the focus as long as the form is there; then whoever had it before. */
export function borrow(form: HTMLElement): { destroy: () => void } {
  const before = document.activeElement as HTMLElement | null;
  form.querySelector<HTMLElement>("input, textarea")?.focus();
  return {
    destroy() {
      const now = document.activeElement;
      if ((now === document.body || form.contains(now)) && before?.isConnected) before.focus();
    },
  };
}
