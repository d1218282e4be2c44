// The meshes of a GLB and their morph targets, by name.
import { Box3, MeshStandardMaterial } from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { bendNormals } from './normals.js';

const CLAY = new MeshStandardMaterial({ color: 0xb9aca0, roughness: 0.75 });
const WIRE = new MeshStandardMaterial({ color: 0x4b84a8, roughness: 1, wireframe: true });

export async function loadAvatar(bytes) {
  const gltf = await new GLTFLoader().parseAsync(bytes, '');
  const meshes = [];
  gltf.scene.traverse((object) => object.isMesh && meshes.push(object));
  const moving = meshes.filter((mesh) => mesh.morphTargetDictionary);
  const names = [...new Set(moving.flatMap((mesh) => Object.keys(mesh.morphTargetDictionary)))];
  // Targets fill some 20 MB of the graphics card, and shaders that know them take longer to build: the first frame, which
  // shows the face at rest, does without.
  const targets = new Map(moving.map(({ geometry }) => [geometry, geometry.morphAttributes]));
  for (const geometry of targets.keys()) geometry.morphAttributes = {};
  const own = new Map(meshes.map((mesh) => [mesh, mesh.material]));
  const wanted = Object.fromEntries(names.map((name) => [name, 0]));
  let added = {}; // what idle life puts upon the weights that are wanted

  function apply(changed) {
    for (const mesh of moving) {
      for (const name of changed) {
        const index = mesh.morphTargetDictionary[name];
        if (index === undefined) continue;
        const more = added[name];
        mesh.morphTargetInfluences[index] = more ? Math.min(Math.max(wanted[name] + more, 0), Math.max(1, wanted[name])) : wanted[name];
      }
    }
  }

  function set(weights) {
    const known = Object.keys(weights).filter((name) => Object.hasOwn(wanted, name));
    for (const name of known) wanted[name] = weights[name];
    apply(known);
  }

  function add(weights) {
    const changed = Object.keys({ ...added, ...weights });
    added = weights;
    apply(changed.filter((name) => Object.hasOwn(wanted, name)));
  }

  function wear(look) {
    for (const mesh of meshes) {
      mesh.material = look === 'clay' ? CLAY : look === 'wire' ? WIRE : own.get(mesh);
    }
  }

  // What an animation has made of the influences becomes what is wanted.
  function adopt() {
    for (const mesh of moving) {
      for (const [name, index] of Object.entries(mesh.morphTargetDictionary)) wanted[name] = mesh.morphTargetInfluences[index];
    }
    return { ...wanted };
  }

  // Expressions show only after this, which takes a while; the page stays awake.
  async function finish() {
    for (const [geometry, attributes] of targets) {
      geometry.morphAttributes = attributes;
      await bendNormals(geometry);
    }
  }

  const hair = meshes.find((mesh) => mesh.name === 'hair');

  return {
    scene: gltf.scene,
    hair,
    bounds: new Box3().setFromObject(gltf.scene, true),
    clips: gltf.animations,
    names,
    set,
    add,
    adopt,
    finish,
    weights: () => ({ ...wanted }),
    rest: () => Object.fromEntries(names.map((name) => [name, 0])),
    wear,
  };
}
