// Ask the search of the built site what people type; exit 1 if a page that answers is not among the first results.
// Usage: node docs/site/check_search.mjs [build/site]. The program is the theme's own search worker.
import fs from "node:fs";
import path from "node:path";
import vm from "node:vm";

const ANSWERS = {
  "cmd-vel": "docs/troubleshooting",
  "cmd_vel": "docs/troubleshooting",
  "/cmd_vel": "docs/troubleshooting",
  "--cmd-vel": "docs/commands/run",
  "real-time factor": "docs/troubleshooting",
  "RTF": "docs/troubleshooting",
  "use_sim_time": "docs/troubleshooting",
  "package://": "docs/troubleshooting",
  "robot does not move": "docs/troubleshooting",
  "scan is all inf": "docs/troubleshooting",
  "the robot slides": "docs/troubleshooting",
  "no pictures": "docs/troubleshooting",
  "runs differ": "docs/troubleshooting",
  "too slow": "docs/troubleshooting",
  "my node sees no messages": "docs/troubleshooting",
  "Nan, Inf or huge value in QACC": "docs/troubleshooting",
  "Unable to find uri[model://sun]": "docs/troubleshooting",
  "Error: mass and inertia of moving bodies must be larger than mjMINVAL Element name 'c', id 2": "docs/troubleshooting",
  "Error: error 'inertia must have positive eigenvalues' in fullinertia": "docs/troubleshooting",
  "Error: inertia must satisfy A + B >= C; use 'balanceinertia' to fix": "docs/troubleshooting",
  "Error opening file 'package:/foo_description/meshes/base.stl'": "docs/troubleshooting",
  "Error: Error opening file 'base.stl': No such file or directory": "docs/troubleshooting",
  "Error: Error opening file 'base.dae', Unknown mesh file type": "docs/troubleshooting",
  "XML Error: URDF joint parent or child missing Element 'joint', line 1": "docs/troubleshooting",
  "XML Error: repeated URDF name:": "docs/troubleshooting",
  "Error: repeated name in mesh array": "docs/troubleshooting",
  "XML Error: bad format in attribute 'size'": "docs/troubleshooting",
  "Error: size 0 must be positive in geom Element name ''": "docs/troubleshooting",
  "mesh volume is too small. Try setting inertia to shell": "docs/troubleshooting",
  "free joint can only be used on top level": "docs/troubleshooting",
  "URDF mimic dropped, gazebo and transmission ignored, two roots, misspelt tag": "docs/troubleshooting",
  "WARNING: Nan, Inf or huge value in QACC at DOF 6. The simulation is unstable. Time = 0.0100.": "docs/troubleshooting",
  "mujoco.FatalError: an OpenGL platform library has not been loaded into this process, GLFWError: (65537) b'The GLFW library is not initialized'": "docs/troubleshooting",
  "RuntimeError: invalid value for environment variable MUJOCO_GL: foo": "docs/troubleshooting",
  "ctypes.ArgumentError No array-type handler for type builtins.NoneType": "docs/troubleshooting",
  "OpenGL.raw.EGL._errors.EGLError: <exception str() failed>": "docs/troubleshooting",
  "ImportError: Cannot initialize a headless EGL display.": "docs/troubleshooting",
  "AttributeError: 'GLXPlatform' object has no attribute 'EGL'": "docs/troubleshooting",
  "gladLoadGL error": "docs/troubleshooting",
  "ImportError: The 'mujoco' package is installed, but its core bindings ('mujoco-core') are missing": "docs/troubleshooting",
  "TypeError: mj_multiRay(): incompatible function arguments": "docs/troubleshooting",
  "Error Code 13: Msg: Unable to find uri[model://sun]": "docs/troubleshooting",
  "Failed to download model. REST response code: 504": "docs/troubleshooting",
  "A model must have at least one link.": "docs/troubleshooting",
  "XML Element[scene], child of element[sdf], not defined in SDF. Copying[scene] as children of [sdf].": "docs/troubleshooting",
  "Attempting to create a mimic constraint for joint but the chosen physics engine does not support mimic": "docs/troubleshooting",
  "[Err] [Ogre2RenderEngine.cc:1131] Unable to create the rendering window: OGRE EXCEPTION(3:RenderingAPIException): OpenGL 3.3 is not supported": "docs/troubleshooting",
  "RLException: Invalid <arg> tag: environment variable 'TURTLEBOT3_MODEL' is not set.": "docs/troubleshooting",
  "KeyError: 'TURTLEBOT3_MODEL'": "docs/troubleshooting",
  "XacroException: substitution args not supported: No module named 'roslaunch'": "docs/troubleshooting",
  "Service /spawn_entity unavailable. Was Gazebo started with GazeboRosFactory?": "docs/troubleshooting",
  "Service /controller_manager/list_controllers not available. Controller manager not available": "docs/troubleshooting",
  "Warning: TF_OLD_DATA ignoring data from the past": "docs/troubleshooting",
  "two robots": "docs/robots",
  "several robots namespace": "docs/robots",
  "spawn a robot": "docs/robots",
  "hot reload": "docs/commands/run",
  "docker": "docs/systems",
  "windows": "docs/systems",
  "jupyter": "docs/systems",
  "from gazebo classic": "docs/from/gazebo_classic",
  "pybullet": "docs/from/pybullet",
  "from ROS 2 launch": "docs/from/ros2_launch",
  "ros2 launch": "packs/launch/docs/launch",
  "LaserScan": "reference/messages/sensor_msgs",
  "geometry_msgs/msg/Twist": "reference/messages/geometry_msgs",
  "SK-SDF-011": "reference/diagnostics/sdf",
  "capture": "reference/python/sensors",
  "sim.world": "reference/python/world_and_contacts",
  "sim.contacts": "reference/python/world_and_contacts",
  "run_until": "reference/python/simulation",
  "exit code": "docs/ci",
};
const FIRST = 5;

const site = process.argv[2] ?? "build/site";
const here = import.meta.dirname ?? path.dirname(new URL(import.meta.url).pathname);
const rewriting = fs.readFileSync(path.join(here, "theme/search_query.js"), "utf8");
const searchQuery = new Function(`${rewriting}; return searchQuery;`)();

const folder = path.join(site, "assets/javascripts/workers");
const worker = fs.readdirSync(folder).find((name) => /^search\..*\.js$/.test(name));
let listener, answered;
const scope = { self: {}, console, postMessage: (m) => answered(m), addEventListener: (_, f) => { listener = f; } };
Object.defineProperty(scope, "lunr", { get: () => scope.self.lunr });
vm.runInContext(fs.readFileSync(path.join(folder, worker), "utf8"), vm.createContext(scope));
const ask = (type, data) => new Promise((resolve) => { answered = resolve; listener({ data: { type, data } }); });

const index = JSON.parse(fs.readFileSync(path.join(site, "search/search_index.json"), "utf8"));
await ask(0, { ...index, options: { suggest: false } });
const queries = process.argv.length > 3 ? process.argv.slice(3) : Object.keys(ANSWERS);
let misses = 0;
for (const query of queries) {
  const found = (await ask(2, searchQuery(query))).data.items.slice(0, FIRST).map(([{ location }]) => location);
  const wanted = ANSWERS[query];
  const isFound = wanted && found.some((location) => location.startsWith(`${wanted}.html`));
  if (!isFound) console.log(`${query} -> ${wanted ?? ""}\n    ${found.join("\n    ")}`);
  misses += wanted && !isFound ? 1 : 0;
}
console.log(`${queries.length} queries, ${misses} without their page among the first ${FIRST}`);
process.exitCode = misses ? 1 : 0;
