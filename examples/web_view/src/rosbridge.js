/** Subscribe to topics of a rosbridge server; come back when the connection is lost. */
export function subscribe(url, handlers, onState) {
  const socket = new WebSocket(url);
  socket.onopen = () => {
    onState("connected");
    for (const topic of Object.keys(handlers)) {
      // Of each topic only the newest message counts: none is worth waiting for.
      socket.send(JSON.stringify({ op: "subscribe", topic, queue_length: 1 }));
    }
  };
  socket.onmessage = ({ data }) => {
    const said = JSON.parse(data);
    if (said.op === "publish") handlers[said.topic]?.(said.msg);
    else if (said.op === "status") console.warn(said.msg);
  };
  socket.onclose = () => {
    onState("lost");
    setTimeout(() => subscribe(url, handlers, onState), 1000);
  };
}

/** A message's stamp in seconds of simulated time. */
export const seconds = ({ sec, nanosec }) => sec + 1e-9 * nanosec;
