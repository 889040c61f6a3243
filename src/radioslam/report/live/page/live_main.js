// The connection to the agent: changes as they come, and whether any come.

const quiet_ms = 5000, again_ms = 3000;
const connection = { is_open: false, has_ended: false, heard: performance.now() };

function write_status() {
  const silent_ms = performance.now() - connection.heard, status = by_id("status");
  const since = format.duration(silent_ms / 1000);
  const [kind, words] = connection.has_ended ? ["ended", "The agent has ended. This is what it knew."]
    : !connection.is_open ? ["lost", `The connection to the agent is lost, since ${since}. Trying again.`]
    : silent_ms > quiet_ms ? ["lost", `Connected, but nothing has come for ${since}.`] : ["", "Connected"];
  status.className = `status ${kind}`;
  if (status.textContent !== words) status.textContent = words;
}

function take_message(event) {
  connection.heard = performance.now();
  const outcome = take_change(JSON.parse(event.data));
  update_map(outcome);
  update_charts();
  write_live_tables();
  write_status();
}

function connect() {
  const source = new EventSource(`events${window.location.search}`);
  source.onopen = () => {
    Object.assign(connection, { is_open: true, has_ended: false, heard: performance.now() });
    write_status();
  };
  source.onmessage = take_message;
  source.addEventListener("end", () => { connection.has_ended = true; write_status(); });
  source.onerror = () => {
    connection.is_open = false;
    write_status();
    if (source.readyState === EventSource.CLOSED) setTimeout(connect, again_ms);
  };
}

document.title = `${report.mission} – radioslam`;
by_id("mission").textContent = report.mission;
setInterval(write_status, 1000);
connect();
