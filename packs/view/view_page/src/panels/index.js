// Panels of the page: side and function `make(app)`, which returns an element or null. A new panel is one line here.
import { makeCameraPanel } from './camera_panel.js';
import { makeDock } from './dock.js';
import { makeDisplayPanel } from './display_panel.js';
import { makeDrivePanel } from './drive_panel.js';
import { makeJointPanel } from './joint_panel.js';
import { makeLayerPanel } from './layer_panel.js';
import { makeModelPanel } from './model_panel.js';
import { makeSelectionPanel } from './selection_panel.js';
import { makeTree } from './tree_panel.js';

export const PANELS = [
  ['left', makeTree],
  ['left', makeSelectionPanel],
  ['left', makeModelPanel],
  ['right', makeLayerPanel],
  ['right', makeDisplayPanel],
  ['right', makeCameraPanel],
  ['right', makeDrivePanel],
  ['right', makeJointPanel],
  ['right', makeDock], // below the scene
];
