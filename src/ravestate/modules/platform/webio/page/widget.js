(function(){var e=document.currentScript;if(e instanceof HTMLScriptElement){let n=()=>t(new URL(`./`,e.src),e.dataset);document.body===null?document.addEventListener(`DOMContentLoaded`,n):n()}function t(e,t){let n=document.createElement(`ravestate-widget`),r=n.attachShadow({mode:`open`}),i=new CSSStyleSheet;i.replaceSync(`
  :host { all: initial; }
  button {
    position: fixed; right: 1.25rem; bottom: 1.25rem; z-index: 2147483000;
    width: 3.5rem; height: 3.5rem; padding: 0.75rem; border: 0; border-radius: 50%;
    background: #2b2740; box-shadow: 0 4px 18px rgb(15 12 25 / 32%); cursor: pointer;
  }
  button:focus-visible { outline: 3px solid #8a7cf0; outline-offset: 3px; }
  svg { display: block; width: 100%; height: 100%; fill: #efeaff; }
  iframe {
    position: fixed; right: 1.25rem; bottom: 5.75rem; z-index: 2147483000;
    width: min(25rem, calc(100vw - 2.5rem)); height: min(38rem, calc(100dvh - 7.5rem));
    border: 1px solid rgb(128 120 140 / 45%); border-radius: 1.125rem;
    background: Canvas; box-shadow: 0 10px 40px rgb(15 12 25 / 28%);
  }
  iframe[hidden] { display: none; }
  @media (max-width: 30rem) {
    iframe { inset: 0; width: 100%; height: 100%; border: 0; border-radius: 0; }
  }
`),r.adoptedStyleSheets=[i];let a=document.createElement(`button`);a.type=`button`,a.setAttribute(`aria-label`,t.title??`Talk with us`),a.setAttribute(`aria-expanded`,`false`);let o=document.createElementNS(`http://www.w3.org/2000/svg`,`svg`);o.setAttribute(`viewBox`,`0 0 48 48`),o.setAttribute(`aria-hidden`,`true`);let s=document.createElementNS(`http://www.w3.org/2000/svg`,`path`);s.setAttribute(`fill-rule`,`evenodd`),s.setAttribute(`d`,`M5 45C4 27 11 9 27 8.500C33.500 8.300 37 11.500 38.800 15.500L47 21.800C43.500 24.600 38.500 25 34.600 24.700C33 28.500 33.800 31 35.500 33.500C32.500 33.200 31.500 32.800 30.300 32C30.300 35.500 31.500 38.500 34.500 41C31 41.300 28.800 40.700 26.800 39.500C26.300 42 26.800 43.500 28 45ZM30.800 14.300A2.100 2.100 0 1 0 30.800 18.500A2.100 2.100 0 1 0 30.800 14.300Z`),o.append(s),a.append(o),r.append(a),document.body.append(n);let c=null,l=!1;function u(n){n&&c===null&&(c=document.createElement(`iframe`),c.title=t.title??`Talk with us`,c.referrerPolicy=`origin`,c.addEventListener(`load`,()=>setTimeout(d,1e3)),c.src=e.href+(t.token===void 0?``:`#token=${encodeURIComponent(t.token)}`),r.append(c)),c!==null&&(c.hidden=!n),a.setAttribute(`aria-expanded`,String(n)),n?c?.focus():a.focus()}function d(){l||console.error(`A page of ${location.origin} wanted to show the chat: add it to the setting webio.origins. (Or there is no agent at ${e.href}.)`)}a.addEventListener(`click`,()=>u(c===null||c.hidden)),window.addEventListener(`message`,e=>{c!==null&&e.source===c.contentWindow&&(e.data===`ravestate:here`&&(l=!0),e.data===`ravestate:close`&&u(!1))})}})();