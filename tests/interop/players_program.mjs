// Reads messages as the players of one publisher's packages do: lines of JSON in, one line of JSON with the failures out.
import { createRequire } from "node:module";
import { createInterface } from "node:readline";

const [folder, scope] = process.argv.slice(2);
const require = createRequire(`${folder}/`);
const { parse } = require(`${scope}/rosmsg`);
const ros1 = require(`${scope}/rosmsg-serialization`);
const ros2 = require(`${scope}/rosmsg2-serialization`);

let messages = 0;
const failures = [];
for await (const line of createInterface({ input: process.stdin })) {
  const { dialect, topic, definition, data } = JSON.parse(line);
  messages += 1;
  try {
    const definitions = parse(definition, { ros2: dialect === "ros2" });
    const bytes = Uint8Array.from(Buffer.from(data, "base64"));
    const { MessageReader, MessageWriter } = dialect === "ros2" ? ros2 : ros1;
    const message = new MessageReader(definitions).readMessage(bytes);
    const plain = message.toJSON === undefined ? message : message.toJSON();
    const again = Buffer.from(new MessageWriter(definitions).writeMessage(plain));
    if (!again.equals(Buffer.from(bytes))) {
      failures.push(`${dialect} ${topic}: ${bytes.length} bytes read, ${again.length} others written`);
    }
  } catch (error) {
    failures.push(`${dialect} ${topic}: ${error}`);
  }
}
console.log(JSON.stringify({ messages, failures }));
