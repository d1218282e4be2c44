// node vrm.mjs FILE... : what @pixiv/three-vrm makes of each VRM, as a JSON array on stdout.
// For every expression: which meshes move, and how far (m) their farthest vertex; for lookAt: where each eye then looks.
import { readFile } from 'node:fs/promises';
import { Matrix4, Texture, Vector3 } from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { VRMLoaderPlugin } from '@pixiv/three-vrm';

// Node has no picture decoder; a blank texture stands in for each.
const blankTextures = () => ({ name: 'blank', loadTexture: () => Promise.resolve(new Texture()) });

function positions(mesh) {
  const count = mesh.geometry.attributes.position.count;
  return Array.from({ length: count }, (_, i) => mesh.localToWorld(mesh.getVertexPosition(i, new Vector3())));
}

function farthest(mesh, rest) {
  return positions(mesh).reduce((most, p, i) => Math.max(most, p.distanceTo(rest[i])), 0);
}

// The head tilts at once: how far (m) hair then is, on its way and at rest again, from where stiff hair would be; the
// same for its upper half. Null without springs.
function swaying(vrm, meshes, rest) {
  const hair = meshes.find((mesh) => mesh.name === 'hair');
  if (!hair || !vrm.springBoneManager?.joints.size) return null;
  const places = rest[meshes.indexOf(hair)];
  const heights = places.map((p) => p.y);
  const middle = (Math.min(...heights) + Math.max(...heights)) / 2;
  const head = vrm.humanoid.getRawBoneNode('head');
  const back = new Matrix4().copy(head.matrixWorld).invert();
  const off = () => {
    vrm.scene.updateMatrixWorld(true);
    const turn = new Matrix4().multiplyMatrices(head.matrixWorld, back);
    const away = positions(hair).map((p, i) => p.distanceTo(places[i].clone().applyMatrix4(turn)));
    return [Math.max(...away), Math.max(...away.filter((_, i) => places[i].y > middle))];
  };
  vrm.springBoneManager.reset();
  vrm.humanoid.getNormalizedBoneNode('head').rotation.z = 0.4;
  const seen = [];
  for (let frame = 0; frame < 180; frame++) {
    vrm.update(1 / 60);
    if (frame === 2 || frame === 179) seen.push(off());
  }
  return { joints: vrm.springBoneManager.joints.size, moving: seen[0], settled: seen[1] };
}

function described(vrm) {
  vrm.scene.updateMatrixWorld(true);
  const meshes = [];
  vrm.scene.traverse((object) => object.isMesh && meshes.push(object));
  const rest = meshes.map(positions);
  const moves = {};
  for (const { expressionName } of vrm.expressionManager.expressions) {
    vrm.expressionManager.setValue(expressionName, 1);
    vrm.update(0);
    moves[expressionName] = Object.fromEntries(meshes.map((mesh, i) => [mesh.name, farthest(mesh, rest[i])]));
    vrm.expressionManager.setValue(expressionName, 0);
  }
  vrm.expressionManager.update();
  const bones = Object.fromEntries(
    Object.entries(vrm.humanoid.humanBones).map(([name, bone]) => [name, bone.node.getWorldPosition(new Vector3()).toArray()]),
  );
  const gaze = {};
  for (const [name, yaw, pitch] of [['left', 90, 0], ['down', 0, 90]]) {
    Object.assign(vrm.lookAt, { autoUpdate: false, yaw, pitch });
    vrm.lookAt.update(0);
    vrm.update(0);
    vrm.scene.updateMatrixWorld(true);
    gaze[name] = ['leftEye', 'rightEye'].map((eye) => {
      const node = vrm.humanoid.getRawBoneNode(eye);
      const mesh = meshes.find((one) => one.name === (eye === 'leftEye' ? 'eye_left' : 'eye_right'));
      const places = rest[meshes.indexOf(mesh)];
      const front = places.reduce((best, p, i) => (p.z > places[best].z ? i : best), 0); // the pole of the iris
      const pole = mesh.localToWorld(mesh.getVertexPosition(front, new Vector3()));
      return pole.sub(node.getWorldPosition(new Vector3())).normalize().toArray();
    });
    Object.assign(vrm.lookAt, { yaw: 0, pitch: 0 });
  }
  const heads = meshes.map((mesh, i) => [mesh.name, rest[i].map((p) => p.y)]);
  return {
    meta: vrm.meta,
    bones,
    moves,
    gaze,
    presets: Object.keys(vrm.expressionManager.presetExpressionMap),
    custom: Object.keys(vrm.expressionManager.customExpressionMap),
    sway: swaying(vrm, meshes, rest),
    heights: Object.fromEntries(heads.map(([name, ys]) => [name, [Math.min(...ys), Math.max(...ys)]])),
  };
}

const reports = [];
for (const file of process.argv.slice(2)) {
  const bytes = await readFile(file);
  const loader = new GLTFLoader().register(blankTextures).register((parser) => new VRMLoaderPlugin(parser));
  const gltf = await loader.parseAsync(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length), '');
  reports.push({ file, ...described(gltf.userData.vrm) });
}
console.log(JSON.stringify(reports));
