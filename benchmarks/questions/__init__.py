"""One file per question; each has ``ask(bench)``, which yields figures."""

QUESTIONS = {
    "answer": "how long until an input is answered?",
    "idle": "what does an agent cost that has nothing to do?",
    "unrelated": "what do rules cost that do not concern the input?",
    "competing": "how long to decide among a thousand rules for one slot?",
    "live_spikes": "what does a spike cost when many are alive?",
    "memory": "what does one more context hold?",
    "importing": "how long does the import take, and what comes with it?",
    "threads": "what does a plain function cost, which runs in a thread?",
    "compiling": "how long does it take to compile a policy?",
    "web_users": "how long do many users of the web page wait for an answer?",
    "watching": "what does an agent cost that is looked into?",
    "text_agent": "how fast is the complete text agent, and how large?",
}
