/** Subscribe to topics of a rosbridge server, each with its type and who takes it; come back when it is lost. */
export function subscribe(url, handlers, onState) {
  const socket = new WebSocket(url);
  socket.onopen = () => {
    onState("connected");
    for (const [topic, [type]] of Object.entries(handlers)) {
      // Of each topic only the newest message counts: none is worth waiting for. With its type it need not be there yet.
      socket.send(JSON.stringify({ op: "subscribe", topic, type, queue_length: 1 }));
    }
  };
  socket.onmessage = ({ data }) => {
    const said = JSON.parse(data);
    if (said.op === "publish") handlers[said.topic]?.[1](said.msg);
    else if (said.op === "status") console.warn(said.msg);
  };
  socket.onclose = () => {
    onState("lost");
    setTimeout(() => subscribe(url, handlers, onState), 1000);
  };
}

/** A message's stamp in seconds of simulated time. */
export const seconds = ({ sec, nanosec }) => sec + 1e-9 * nanosec;
