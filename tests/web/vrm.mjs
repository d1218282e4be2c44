// node vrm.mjs FILE... : what @pixiv/three-vrm makes of each VRM, as a JSON array on stdout.
// For every expression: which meshes move, and how far (m) their farthest vertex; for lookAt: where each eye then looks.
import { readFile } from 'node:fs/promises';
import { Texture, Vector3 } from 'three';
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
