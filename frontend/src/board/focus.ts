/** A Svelte action: focus the first field of a form. The previous element gets the focus back when the form goes. */
export function takeFocus(form: HTMLElement): { destroy: () => void } {
  const before = document.activeElement as HTMLElement | null;
  form.querySelector<HTMLElement>("input, textarea")?.focus();
  return {
    destroy() {
      const now = document.activeElement;
      if ((now === document.body || form.contains(now)) && before?.isConnected) before.focus();
    },
  };
}
