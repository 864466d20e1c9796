const at = id => document.getElementById(id);
const talks = document.documentElement.dataset.mode !== "read-only";
if (!talks) for (const part of document.querySelectorAll("[data-talks]")) part.remove();

function add(parent, tag, kind, text) {
  const node = document.createElement(tag);
  if (kind) node.className = kind;
  if (text !== undefined) node.textContent = text;
  parent.append(node);
  return node;
}
// What is the same already stays untouched: twenty states a second.
function put(node, text) {
  text = String(text);
  if (node.textContent !== text) node.textContent = text;
}
const hex = (word, digits) => word.toString(16).toUpperCase().padStart(digits, "0");
const fixed = (number, digits) => {
  const text = Math.abs(number).toFixed(digits);
  return (number < 0 && Number(text) !== 0 ? "−" : "") + text;
};
const percent = share => fixed(100 * share, 1) + " %";

function lamp(parent, text, kind, meaning) {
  const node = add(parent, "span", "lamp " + kind, text);
  node.title = meaning;
  return on => {
    node.classList.toggle("lit", on);
    node.setAttribute("aria-label", meaning + (on ? ": on" : ": off"));
  };
}

// A list of names and values; `rows(name)` gives the value's element, made where it is missing.
function list(id) {
  const cells = new Map();
  return (name, text) => {
    if (!cells.has(name)) {
      add(at(id), "dt", "", name);
      cells.set(name, add(at(id), "dd"));
    }
    put(cells.get(name), text);
    return cells.get(name);
  };
}

// ---------------------------------------------------------------------------------------------------------- the port

let socket = null, lastId = 0;
const waiting = new Map();  // id to what is done with the answer

function command(line, done) {
  if (!socket || socket.readyState !== WebSocket.OPEN) return done({lines: ["not connected"], refused: true});
  waiting.set(++lastId, done);
  socket.send(JSON.stringify({kind: "command", id: lastId, line: line}));
}

const KEPT_LINES = 400;
function show(line, kind) {
  if (!talks) return;
  const said = at("said"), atEnd = said.scrollTop + said.clientHeight >= said.scrollHeight - 4;
  add(said, "div", kind, line);
  while (said.childElementCount > KEPT_LINES) said.firstChild.remove();
  if (atEnd) said.scrollTop = said.scrollHeight;
}
function say(line) {
  show("› " + line, "asked");
  command(line, answer => {
    for (const text of answer.lines) show(text, answer.refused ? "refused" : "");
    if (answer.cut) show("(the rest is cut off)", "refused");
  });
}

if (talks) {
  const typed = [], input = at("line");
  let place = 0;
  at("say").onsubmit = event => {
    event.preventDefault();
    const line = input.value.trim();
    if (!line) return;
    if (typed[typed.length - 1] !== line) typed.push(line);
    place = typed.length;
    input.value = "";
    say(line);
  };
  input.onkeydown = event => {
    const step = {ArrowUp: -1, ArrowDown: 1}[event.key];
    if (!step) return;
    event.preventDefault();
    place = Math.min(Math.max(place + step, 0), typed.length);
    input.value = typed[place] || "";
  };
}

function keys(parent, addressed, names) {
  if (!talks) return;
  const row = add(parent, "div", "keys");
  for (const [key, meaning] of names) {
    const button = add(row, "button", key === "K" || key === "A" ? "stop" : "", key);
    button.title = addressed + key + ": " + meaning;
    button.setAttribute("aria-label", addressed + " " + meaning);
    button.onclick = () => say(addressed + key);
  }
}

// ----------------------------------------------------------------------------------------------------------- motors

const MOTOR_KEYS = [["J-", "jog negative"], ["J/", "stop, close the loop"], ["J+", "jog positive"],
  ["HM", "home"], ["K", "kill"]];
const PLOTS = [["position", "position", 2], ["velocity", "velocity", 0.1], ["error", "following error", 2]];
const motors = new Map();

function newMotor(number) {
  const row = add(at("motors"), "div", "motor"), who = add(row, "div", "who"), name = add(who, "div", "name");
  row.dataset.motor = number;
  const choose = add(name, "button", "", "#" + number);
  choose.title = "status words of motor " + number;
  choose.onclick = () => {
    at("status-of").value = "motor " + number;
    showStatus();
  };
  const motor = {row, state: add(name, "span"), lamps: add(who, "div", "lamps"), history: new History(), plots: {}};
  const minus = lamp(motor.lamps, "−LIM", "bad", "in the negative limit");
  const plus = lamp(motor.lamps, "+LIM", "bad", "in the positive limit");
  const fault = lamp(motor.lamps, "FAULT", "bad", "amplifier fault or overload");
  const follow = lamp(motor.lamps, "FE", "bad", "fatal following error");
  const warning = lamp(motor.lamps, "WARN", "warn", "warning following error");
  const home = lamp(motor.lamps, "HOME", "good", "home complete");
  motor.light = (one, two) => {
    minus(bit(one, 22));
    plus(bit(one, 21));
    fault(bit(two, 3) || bit(two, 5));
    follow(bit(two, 2) || bit(two, 6));
    warning(bit(two, 1));
    home(bit(two, 10));
  };
  for (const [kind, text] of PLOTS) {
    const cell = add(row, "div", "plot");
    add(cell, "i", "", text);
    motor.plots[kind] = {number: add(cell, "b"), canvas: add(cell, "canvas", kind)};
    motor.plots[kind].canvas.setAttribute("role", "img");
    motor.plots[kind].canvas.setAttribute("aria-label", text + " of motor " + number + ", ten seconds");
  }
  keys(row, "#" + number, MOTOR_KEYS);
  return motor;
}

function stateOf(one, two) {
  if (!bit(one, 23)) return "not activated";
  if (!bit(one, 19)) return "killed";
  if (bit(one, 18)) return "open loop";
  if (bit(one, 10)) return "searches";
  if (!bit(one, 13)) return "moves";
  return bit(two, 0) ? "in position" : "closed loop";
}

function showMotors(state) {
  for (const [number, motor] of motors)
    if (!state.motors.some(m => m.number === number)) {
      motor.row.remove();
      motors.delete(number);
    }
  for (const m of state.motors) {
    if (!motors.has(m.number)) motors.set(m.number, newMotor(m.number));
    const motor = motors.get(m.number), [one, two] = m.status;
    motor.history.add(state.times, {position: m.actuals, error: m.errors});
    motor.light(one, two);
    put(motor.state, stateOf(one, two));
    put(motor.plots.position.number, fixed(m.position, 1));
    put(motor.plots.velocity.number, fixed(m.velocity, 2));
    put(motor.plots.error.number, fixed(m.error, 1));
  }
}

function drawMotors(end) {
  for (const motor of motors.values()) {
    const h = motor.history, values = {position: h.series.position, velocity: h.slope("position"), error: h.series.error};
    for (const [kind, , least] of PLOTS) drawPlot(motor.plots[kind].canvas, h.times, values[kind] || [], end, least);
  }
}

// ----------------------------------------------------------------------------------------------- coordinate systems

const SYSTEM_KEYS = [["A", "abort"], ["H", "feed hold"], ["R", "run"]];
const systems = new Map();

function newSystem(number) {
  const row = add(at("systems"), "div", "system"), who = add(row, "div", "who"), name = add(who, "div", "name");
  row.dataset.system = number;
  const choose = add(name, "button", "", "&" + number);
  choose.onclick = () => {
    at("status-of").value = "system " + number;
    showStatus();
  };
  const system = {row, feed: add(name, "span", "feed")}, lamps = add(who, "div", "lamps");
  const runs = lamp(lamps, "RUN", "good", "program runs"), placed = lamp(lamps, "IN POS", "good", "in position");
  const full = lamp(lamps, "FULL", "warn", "Rotary Buffer Full"), error = lamp(lamps, "ERROR", "bad", "run-time error");
  system.light = status => {
    runs(bit(status[0], 0));
    placed(bit(status[1], 17));
    full(bit(status[1], 16));
    error(bit(status[1], 22));
  };
  const line = add(row, "div", "line");
  system.at = add(line, "span");
  system.text = add(line, "code");
  const ring = add(row, "div", "ring");
  system.ring = add(ring, "span");
  system.fill = add(ring, "div", "fill");
  system.level = add(system.fill, "div");
  system.i16 = add(system.fill, "i");
  system.i17 = add(system.fill, "i");
  keys(row, "&" + number, SYSTEM_KEYS);
  return system;
}

function showSystems(state) {
  for (const [number, system] of systems)
    if (!state.systems.some(s => s.number === number)) {
      system.row.remove();
      systems.delete(number);
    }
  const {i16, i17} = state.request;
  for (const s of state.systems) {
    if (!systems.has(s.number)) systems.set(s.number, newSystem(s.number));
    const system = systems.get(s.number), size = s.words + s.room, line = s.line;
    system.light(s.status);
    put(system.feed, "feed " + fixed(s.feed, 1) + " %");
    put(system.at, (line ? line.at : "no program") + (s.error ? ", run-time error " + s.error : ""));
    put(system.text, line ? line.text : "");
    put(system.ring, size ? `PR ${s.lines} lines, ${s.words} of ${size} words` : "no rotary buffer");
    system.fill.hidden = size === 0;
    const most = Math.max(2 * i17, s.lines, 1), share = lines => 100 * lines / most + "%";
    system.level.style.width = share(s.lines);
    system.fill.classList.toggle("full", bit(s.status[1], 16));
    for (const [mark, lines, name] of [[system.i16, i16, "I16"], [system.i17, i17, "I17"]]) {
      mark.style.left = share(lines);
      mark.title = name + " = " + lines + " lines";
    }
  }
}

// --------------------------------------------------------------------------------------------------- status words

let shown = "";
const statusWords = {
  motor: (m, n) => [["Word 1", "X:$" + hex(0x80 * n + 0x30, 6), m.status[0]],
    ["Word 2", "Y:$" + hex(0x80 * n + 0x40, 6), m.status[1]]],
  system: (s, n) => [["Word 1", "X:$" + hex(0x2040 + 0x100 * (n - 1), 6), s.status[0]],
    ["Word 2", "Y:$" + hex(0x203F + 0x100 * (n - 1), 6), s.status[1]],
    ["Word 3", "Y:$" + hex(0x2040 + 0x100 * (n - 1), 6), s.status[2]]],
  global: g => [["Word 1", "X:$000006", g.status[0]], ["Word 2", "Y:$000006", g.status[1]]],
};

function showStatus() {
  if (!latest) return;
  const choices = [...latest.motors.map(m => ["motor " + m.number, "motor " + m.number]),
    ...latest.systems.map(s => ["system " + s.number, "coordinate system " + s.number]),
    ["global", "the controller"]];
  const select = at("status-of"), names = choices.map(c => c[0]).join();
  if (select.dataset.names !== names) {
    const before = select.value;
    select.replaceChildren();
    for (const [value, text] of choices) add(select, "option", "", text).value = value;
    if (choices.some(c => c[0] === before)) select.value = before;
    select.dataset.names = names;
  }
  const [kind, text] = select.value.split(" "), number = Number(text);
  const one = kind === "global" ? {status: latest.global} :
    (kind === "motor" ? latest.motors : latest.systems).find(x => x.number === number);
  const words = statusWords[kind](one, number);
  if (shown !== select.value) {
    shown = select.value;
    at("status").replaceChildren();
    words.forEach(([name, address], i) => {
      const box = add(at("status"), "div"), head = add(box, "h3", "", name + " ");
      add(head, "code", "", address);
      head.append(" ");
      box.value = add(head, "code", "value");
      const bits = add(box, "ul", "bits");
      box.rows = STATUS[kind][i].map(([high, low, meaning]) => {
        const row = add(bits, "li", high === low ? "" : "number");
        add(row, "b", "", high === low ? high : high + "–" + low);
        row.meaning = add(row, "span", "", meaning);
        return row;
      });
    });
    at("pins")?.remove();
    if (kind === "motor") add(add(at("status"), "div"), "h3").id = "pins";
  }
  words.forEach(([, , value], i) => {
    const box = at("status").children[i];
    put(box.value, "$" + hex(value, 6));
    STATUS[kind][i].forEach(([high, low, meaning, says], j) => {
      const field = value >> low & (1 << high - low + 1) - 1;
      box.rows[j].classList.toggle("set", high === low && field === 1);
      if (high !== low) put(box.rows[j].meaning, meaning + ": " + (says ? says(field) : field));
    });
  });
  if (kind === "motor")
    put(at("pins"), one.pins ? "Pins of the channel: " + Object.entries(one.pins).map(p => p.join(" ")).join(", ") :
      "Pins: no channel of this board is motor " + number + "'s");
}
at("status-of").onchange = showStatus;

// --------------------------------------------------------------------------------------------------------- the side

const request = list("request"), clocks = list("clocks"), tasks = list("tasks"), watchdog = list("watchdog");

function showRequest(state) {
  const r = state.request, system = state.systems.find(s => s.number === r.selected);
  const lines = system ? system.lines : 0, high = level => level ? "high" : "low";
  request("shown on the pin", r.selected ? "&" + r.selected : "no coordinate system");
  request("1  ?? Rotary Buffer Full", system ? (bit(system.status[1], 16) ? 1 : 0) : "–");
  request("2  PR", `${lines} lines (I16 ${r.i16}, I17 ${r.i17})`);
  request("3  line to the host", `BREQ ${high(r.breq)}, IRQ ${high(r.irq)}`);
  request("4  interrupt controller", `IST $${hex(r.ist, 2)}, IR1 ${bit(r.ist, 1) ? 1 : 0}`);
  request("enabled lines, their levels", `MSK $${hex(r.msk, 2)}, SIG $${hex(r.sig, 2)}`);
}

function showClocks(state) {
  const c = state.clocks;
  clocks("I19, source chosen", c.i19);
  clocks("source that drives", c.source || "none");
  clocks("phase", fixed(c.phase_khz, 3) + " kHz");
  clocks("servo", fixed(c.servo_khz, 3) + " kHz");
  clocks("servo interrupts counted", fixed(c.counted_khz, 3) + " kHz");
  clocks("I10, servo period", c.i10);
  clocks("CPU, I52 = " + c.i52, fixed(c.cpu_mhz, 2) + " MHz");
}

const bars = new Map();
function showTask(name, task) {
  tasks(name, `${fixed(task.us, 1)} µs, load ${percent(task.load)}`).title =
    "from interrupt to return; the load is without the tasks that interrupted it (firmware:8.1)";
  if (!bars.has(name)) bars.set(name, add(add(at("tasks"), "div", "load"), "div"));
  bars.get(name).style.width = percent(task.load).replace("−", "-").replace(" ", "");
}
function showTasks(state) {
  const t = state.tasks;
  showTask("phase", t.phase);
  showTask("servo", t.servo);
  showTask("real-time", t.real_time);
  tasks("real-time, longest", `${fixed(t.real_time_longest_us, 1)} µs`);
  tasks("background, longest", `${state.watchdog.reload - state.watchdog.lowest} servo cycles`);
  tasks("CPU asleep", percent(t.asleep));
}

function showWatchdog(state) {
  const w = state.watchdog;
  watchdog("circuit", w.tripped ? "tripped" : "not tripped");
  watchdog("counter, Y:$25", `${w.count} of ${w.reload}`);
  watchdog("lowest since reset, X:$25", w.lowest);
  at("tripped").hidden = !w.tripped;
}

// ------------------------------------------------------------------------------------------------------ watch list

// What a controller is asked for a value with, and changes nothing.
const ASKS = /^(?:[IPQM](?:\d+|\([^=()]+\))|\?\?\?|SIZE)$/i;
// `#n` and `&n` hold for all clients: one that has sent `#2` would jog motor 1 with its `J+`.
const ADDRESSES = /[#&]/;
const PLAIN = /^[!-:<-~]+$/;
const EXPECTED = "not watched: expected ASCII without blanks and semicolons";
const INSTEAD = "not watched: # and & change what all clients address; expected motor1.actual, motor1.error, " +
  "motor1.velocity or an address (Y:$25)";
const ASK_EVERY_MS = 500;
const watched = new Map();

function watchMemory() {
  const items = [...watched.values()].filter(w => w.from === "memory").map(w => w.item);
  if (socket && socket.readyState === WebSocket.OPEN) socket.send(JSON.stringify({kind: "watch", items: items}));
}

at("add").onsubmit = event => {
  event.preventDefault();
  const item = at("item").value.trim(), table = at("watched");
  if (!item || watched.has(item) || watched.size >= 32) return;
  at("item").value = "";
  const row = add(table, "tr"), wrong = ADDRESSES.test(item) ? INSTEAD : ASKS.test(item) || PLAIN.test(item) ? "" : EXPECTED,
    one = {item, from: wrong ? "" : ASKS.test(item) ? "port" : "memory"};
  add(add(row, "td"), "code", "", item);
  one.value = add(row, "td", "", "–");
  add(row, "td", "", one.from);
  const remove = add(add(row, "td"), "button", "", "×");
  remove.setAttribute("aria-label", "remove " + item);
  remove.onclick = () => {
    row.remove();
    watched.delete(item);
    watchMemory();
  };
  watched.set(item, one);
  if (wrong) put(one.value, wrong);
  if (one.from === "port" && !talks) put(one.value, "the page is read only");
  if (one.from === "memory") watchMemory();
};

function showWatched(state) {
  for (const one of watched.values()) {
    const value = state.watch[one.item];
    if (one.from === "memory" && value !== undefined) put(one.value, typeof value === "number" ? +value.toPrecision(10) : value);
  }
}

// One after the other, so that a button waits for one of them at most.
let asking = false;
function ask(rest) {
  const one = rest.shift();
  asking = one !== undefined;
  if (!asking) return;
  command(one.item, answer => {
    put(one.value, answer.lines.join(" "));
    ask(rest);
  });
}
setInterval(() => {
  if (!asking && !document.hidden && talks) ask([...watched.values()].filter(w => w.from === "port"));
}, ASK_EVERY_MS);

// ------------------------------------------------------------------------------------------------------------ states

let latest = null, drawn = null;
const rate = {wall: 0, ms: 0, cost: null};

function draw() {
  if (latest && latest !== drawn && !document.hidden) drawMotors(latest.ms);
  drawn = latest;
}

function showState(state) {
  latest = state;
  const wall = performance.now();
  put(at("time"), fixed(state.ms / 1000, 2) + " s");
  if (wall - rate.wall >= 1000) {
    const cost = state.cost;
    put(at("rate"), !rate.wall ? "simulated" :
      `simulated, ${fixed((state.ms - rate.ms) / (wall - rate.wall), 2)} of real time; the page takes ` +
      `${percent((cost.page - rate.cost.page) / (cost.all - rate.cost.all))} of its processor time`);
    Object.assign(rate, {wall, ms: state.ms, cost});
  }
  showMotors(state);
  showSystems(state);
  showStatus();
  showRequest(state);
  showClocks(state);
  showTasks(state);
  showWatchdog(state);
  showWatched(state);
  requestAnimationFrame(draw);
}

function linked(text, good) {
  put(at("link"), text);
  at("link").className = "lamp lit " + (good ? "good" : "bad");
}

function connect() {
  socket = new WebSocket(`ws://${location.host}/socket${location.search}`);
  socket.onopen = () => {
    linked("connected", true);
    watchMemory();
  };
  socket.onmessage = event => {
    const message = JSON.parse(event.data);
    if (message.kind === "state") return showState(message);
    if (message.kind === "about") {
      document.title = message.board + " – brick";
      put(at("about"), `${message.board}, ${message.engine}, ${message.version}` + (message.read_only ? ", read only" : ""));
    }
    const done = waiting.get(message.id);
    waiting.delete(message.id);
    if (message.kind === "answer" && done) return done(message);
    if (message.kind !== "mistake") return;
    if (done) done({lines: [message.text], refused: true});
    else show(message.text, "refused");
  };
  socket.onclose = () => {
    linked("not connected", false);
    for (const done of waiting.values()) done({lines: ["the connection has ended"], refused: true});
    waiting.clear();
    setTimeout(connect, 2000);
  };
}
window.addEventListener("resize", () => { drawn = null; requestAnimationFrame(draw); });
connect();
