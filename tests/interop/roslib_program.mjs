// Programs that use stock roslib under Node. The first two words: roslib's own file, what to do.
//   node roslib_program.mjs ROSLIB talk URL TOKEN     every kind of operation, then once more after a restart
//   node roslib_program.mjs ROSLIB drive URL SECONDS  drive until the odometry's stamp has come so far
// What they saw goes to standard output, one line of JSON each time.

import { createHash, randomUUID } from "node:crypto";
import { pathToFileURL } from "node:url";

const [file, job, url, word] = process.argv.slice(2);
const { Action, Param, Ros, Service, Topic } = await import(pathToFileURL(file));

const later = (start) => new Promise(start);
const first = (topic, wanted = () => true) =>
  later((done) => {
    const take = (message) => {
      if (wanted(message)) {
        topic.unsubscribe(take);
        done(message);
      }
    };
    topic.subscribe(take);
  });

function authenticate(ros) {
  const now = Math.floor(Date.now() / 1000);
  const shown = ["roslib", "simconsole", randomUUID(), now, "control", now + 60];
  const mac = createHash("sha512").update([word, ...shown].join("")).digest("hex");
  ros.authenticate(mac, ...shown);
}

async function connected() {
  const ros = new Ros();
  ros.on("error", () => {});
  await later((done) => {
    ros.on("connection", done);
    ros.connect(url);
  });
  return ros;
}

async function talk() {
  const ros = await connected();
  const seen = {};
  const odometry = (compression) => new Topic({ ros, name: "/odom", messageType: "nav_msgs/Odometry", compression });

  const refused = new Service({ ros, name: "/rosapi/get_time", serviceType: "rosapi/GetTime" });
  seen.stranger = await later((done) => refused.callService({}, () => done("let in"), () => done("turned away")));
  authenticate(ros);
  ros.on("connection", () => authenticate(ros));

  for (const form of ["none", "png", "cbor"]) {
    const { header, pose } = await first(odometry(form));
    seen[form] = [header.frame_id, pose.covariance.length, pose.covariance.constructor.name];
    // Answers come in order: what was on its way in this form has come before the next one is asked for.
    await later((done, fail) => refused.callService({}, done, fail));
  }

  const chatter = { ros, name: "/chatter", messageType: "std_msgs/String" };
  const [speaker, listener] = [new Topic(chatter), new Topic(chatter)];
  speaker.advertise();
  const heard = first(listener);
  speaker.publish({ data: "hello" });
  seen.chatter = (await heard).data;

  const add = new Service({ ros, name: "/add", serviceType: "example_interfaces/AddTwoInts" });
  await add.advertise((request, response) => {
    response.sum = request.a + request.b;
    return true;
  });
  const caller = new Service({ ros, name: "/add", serviceType: "example_interfaces/AddTwoInts" });
  seen.sum = (await later((done, fail) => caller.callService({ a: 2, b: 3 }, done, fail))).sum;
  const none = new Service({ ros, name: "/none", serviceType: "std_srvs/Trigger" });
  seen.failed = await later((done) => none.callService({}, () => done("answered"), done));

  const fibonacci = { ros, name: "/fibonacci", actionType: "example_interfaces/action/Fibonacci" };
  const server = new Action(fibonacci);
  const goals = new Map();
  server.advertise(
    (goal, id) => {
      server.sendFeedback(id, { sequence: [0, 1] });
      if (goal.order > 10) goals.set(id, goal);
      else server.setSucceeded(id, { sequence: [0, 1, 1, 2].slice(0, goal.order + 1) });
    },
    (id) => server.setCanceled(id, { sequence: [0] }),
  );
  const client = new Action(fibonacci);
  seen.feedback = [];
  seen.result = await later((done, fail) =>
    client.sendGoal({ order: 3 }, done, (feedback) => seen.feedback.push(feedback.sequence), fail),
  );
  seen.cancelled = await later((done) => {
    const id = client.sendGoal({ order: 99 }, done, () => client.cancelGoal(id), (error) => done(String(error)));
  });

  const param = new Param({ ros, name: "/friction" });
  await later((done, fail) => param.set(0.8, done, fail));
  seen.param = await later((done, fail) => param.get(done, fail));
  await later((done, fail) => param.delete(done, fail));

  seen.topics = await later((done, fail) => ros.getTopics((found) => done(found.topics.includes("/odom")), fail));
  seen.type = await later((done, fail) => ros.getTopicType("/odom", done, fail));

  // Left subscribed: roslib asks again by itself once it is connected again.
  const kept = odometry("none");
  let again = false;
  const returned = later((done) => kept.subscribe(() => again && done("odometry is back")));
  await first(odometry("cbor"));
  ros.on("close", () => setTimeout(() => ros.connect(url), 100));
  ros.on("connection", () => (again = true));
  console.log(JSON.stringify(seen));
  console.log(JSON.stringify({ returned: await returned }));
}

async function drive() {
  const ros = await connected();
  const control = new Topic({ ros, name: "/control/command/control_cmd", messageType: "autoware_control_msgs/Control" });
  const requests = new Topic({ ros, name: "/console/request", messageType: "std_msgs/String" });
  control.advertise();
  requests.advertise();
  let answers = 0;
  const began = Date.now();
  const odometry = new Topic({ ros, name: "/odom", messageType: "nav_msgs/Odometry" });
  const last = await first(odometry, ({ header: { stamp }, pose, twist }) => {
    if (answers === 10) requests.publish({ data: "autonomous" });
    answers += 1;
    // Towards y = 3 m and along x, well damped: where it is at the end is no matter of the moment.
    const heading = 2.0 * Math.atan2(pose.pose.orientation.z, pose.pose.orientation.w);
    control.publish({
      stamp,
      lateral: { steering_tire_angle: -0.01 * (pose.pose.position.y - 3.0) - 0.2 * heading },
      longitudinal: { velocity: 8.0, acceleration: Math.min(2.0, 8.0 - twist.twist.linear.x) },
    });
    return stamp.sec + stamp.nanosec * 1e-9 >= Number(word);
  });
  const { x, y } = last.pose.pose.position;
  console.log(JSON.stringify({ answers, x_m: x, y_m: y, wall_s: (Date.now() - began) / 1000 }));
}

await (job === "talk" ? talk() : drive());
process.exit(0);
