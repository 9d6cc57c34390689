"""One file per question; each has ``ask(bench)``, which yields figures."""

QUESTIONS = {
    "answer": "how long until an input is answered?",
    "idle": "what does an idle agent cost?",
    "unrelated": "what do unrelated rules cost?",
    "competing": "how long to decide among a thousand rules for one slot?",
    "live_spikes": "what does a spike cost when many are alive?",
    "load": "how evenly are many contexts served at half load?",
    "growing": "what does ten times as much work cost?",
    "memory": "how much memory does one more context hold?",
    "importing": "how long does the import take, and which packages does it load?",
    "threads": "what does a plain function in a thread cost?",
    "compiling": "how long does it take to compile a policy?",
    "web_users": "how long do many users of the web page wait for an answer?",
    "watching": "what does the board cost the agent?",
    "voice": "how well does the agent listen, take turns and give way, and how long does the user wait?",
    "eyes": "how many pictures does the agent look at, and what do its eyes cost the conversation?",
    "ros": "what does an agent add to a message of ROS, and does it keep up?",
    "text_agent": "how fast and how large is the complete text agent?",
}
