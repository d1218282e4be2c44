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
  moving.forEach((mesh) => bendNormals(mesh.geometry));
  const names = [...new Set(moving.flatMap((mesh) => Object.keys(mesh.morphTargetDictionary)))];
  const own = new Map(meshes.map((mesh) => [mesh, mesh.material]));

  function set(weights) {
    for (const mesh of moving) {
      for (const [name, weight] of Object.entries(weights)) {
        const index = mesh.morphTargetDictionary[name];
        if (index !== undefined) mesh.morphTargetInfluences[index] = weight;
      }
    }
  }

  function wear(look) {
    for (const mesh of meshes) {
      mesh.material = look === 'clay' ? CLAY : look === 'wire' ? WIRE : own.get(mesh);
    }
  }

  function weights() {
    const found = Object.fromEntries(names.map((name) => [name, 0]));
    for (const mesh of moving) {
      for (const [name, index] of Object.entries(mesh.morphTargetDictionary)) found[name] = mesh.morphTargetInfluences[index];
    }
    return found;
  }

  const hair = meshes.find((mesh) => mesh.name === 'hair');

  return { scene: gltf.scene, hair, bounds: new Box3().setFromObject(gltf.scene, true), clips: gltf.animations, names, set, weights, wear };
}
