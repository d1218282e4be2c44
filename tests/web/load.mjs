// node load.mjs FILE... : what three.js makes of each GLB, as a JSON array on stdout.
// For every mesh: its targets, and how far (m) the vertex that moves most goes when a target's influence is 1.
import { readFile } from 'node:fs/promises';
import { AnimationMixer, Box3, Texture, Vector3 } from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';

// Node has no picture decoder; a blank texture stands in for each.
const blankTextures = () => ({ name: 'blank', loadTexture: () => Promise.resolve(new Texture()) });

function positions(mesh) {
  const count = mesh.geometry.attributes.position.count;
  return Array.from({ length: count }, (_, i) => mesh.getVertexPosition(i, new Vector3()));
}

function reach(mesh, name, rest) {
  const index = mesh.morphTargetDictionary[name];
  mesh.morphTargetInfluences[index] = 1;
  const farthest = positions(mesh).reduce((most, p, i) => Math.max(most, p.distanceTo(rest[i])), 0);
  mesh.morphTargetInfluences[index] = 0;
  return farthest;
}

function described(mesh) {
  const rest = positions(mesh);
  const bounds = new Box3().setFromPoints(rest);
  const names = Object.keys(mesh.morphTargetDictionary ?? {});
  return {
    name: mesh.userData.name ?? mesh.name,
    vertices: rest.length,
    triangles: mesh.geometry.index.count / 3,
    position: mesh.position.toArray(),
    bounds: [bounds.min.toArray(), bounds.max.toArray()],
    scale: mesh.scale.toArray(),
    textured: Boolean(mesh.material.map),
    doubleSided: mesh.material.side === 2,
    targets: names,
    influences: [...(mesh.morphTargetInfluences ?? [])],
    reach: Object.fromEntries(names.map((name) => [name, reach(mesh, name, rest)])),
  };
}

const reports = [];
for (const file of process.argv.slice(2)) {
  const bytes = await readFile(file);
  const loader = new GLTFLoader().register(blankTextures);
  const gltf = await loader.parseAsync(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length), '');
  const meshes = [];
  gltf.scene.traverse((object) => object.isMesh && meshes.push(object));
  const report = { file, meshes: meshes.map(described), animations: [] };
  for (const clip of gltf.animations) {
    const mixer = new AnimationMixer(gltf.scene);
    mixer.clipAction(clip).play();
    mixer.setTime(clip.duration / 2);
    const halfway = meshes.map((mesh) => [...(mesh.morphTargetInfluences ?? [])]);
    const turns = meshes.map((mesh) => mesh.quaternion.toArray());
    report.animations.push({ name: clip.name, duration: clip.duration, tracks: clip.tracks.length, halfway, turns });
  }
  reports.push(report);
}
console.log(JSON.stringify(reports));
