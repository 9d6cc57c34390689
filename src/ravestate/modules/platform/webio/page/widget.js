(function(){var e=/\sd="([^"]+)"/.exec(`<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 48 48">
  <style>
  path {
    fill: #2b2740;
  }
  @media (prefers-color-scheme: dark) {
    path {
      fill: #cfc9f7;
    }
  }
  </style>
  <path
    fill-rule="evenodd"
    d="M5 45C4 27 11 9 27 8.500C33.500 8.300 37 11.500 38.800 15.500L47 21.800C43.500 24.600 38.500 25 34.600 24.700C33 28.500 33.800 31 35.500 33.500C32.500 33.200 31.500 32.800 30.300 32C30.300 35.500 31.500 38.500 34.500 41C31 41.300 28.800 40.700 26.800 39.500C26.300 42 26.800 43.500 28 45ZM30.800 14.300A2.100 2.100 0 1 0 30.800 18.500A2.100 2.100 0 1 0 30.800 14.300Z"
  />
</svg>
`)?.[1]??``,t=`
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
`,n=1e3,r=document.currentScript;if(r instanceof HTMLScriptElement){let e=()=>i(new URL(`./`,r.src),r.dataset);document.body===null?document.addEventListener(`DOMContentLoaded`,e):e()}function i(r,i){let a=document.createElement(`ravestate-widget`),o=a.attachShadow({mode:`open`}),s=new CSSStyleSheet;s.replaceSync(t),o.adoptedStyleSheets=[s];let c=document.createElement(`button`);c.type=`button`,c.setAttribute(`aria-label`,i.title??`Talk with us`),c.setAttribute(`aria-expanded`,`false`);let l=document.createElementNS(`http://www.w3.org/2000/svg`,`svg`);l.setAttribute(`viewBox`,`0 0 48 48`),l.setAttribute(`aria-hidden`,`true`);let u=document.createElementNS(`http://www.w3.org/2000/svg`,`path`);u.setAttribute(`fill-rule`,`evenodd`),u.setAttribute(`d`,e),l.append(u),c.append(l),o.append(c),document.body.append(a);let d=null,f=!1;function p(e){e&&d===null&&(d=document.createElement(`iframe`),d.title=i.title??`Talk with us`,d.allow=`microphone; camera; autoplay`,d.referrerPolicy=`origin`,d.addEventListener(`load`,()=>setTimeout(m,n)),d.src=r.href+(i.token===void 0?``:`#token=${encodeURIComponent(i.token)}`),o.append(d)),d!==null&&(d.hidden=!e),e||d?.contentWindow?.postMessage(`ravestate:hidden`,r.origin),c.setAttribute(`aria-expanded`,String(e)),e?d?.focus():c.focus()}function m(){f||console.error(`A page of ${location.origin} may not embed the chat: add it to the setting webio.origins. (Or no agent runs at ${r.href}.)`)}c.addEventListener(`click`,()=>p(d===null||d.hidden)),window.addEventListener(`message`,e=>{d!==null&&e.source===d.contentWindow&&(e.data===`ravestate:here`&&(f=!0),e.data===`ravestate:close`&&p(!1))})}})();