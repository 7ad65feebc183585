// The crane as it is drawn while it moves and the processor draws: light, tone and haze are computed at the corners of surfaces, not at every picture
// element, and all parts that keep their shape are drawn at once. That is where the time of such pictures goes. Faces look as usual, without gloss;
// shadows fall on the ground alone.
import { BufferAttribute, BufferGeometry, Color, Group, LineSegments, Mesh, ShaderMaterial, Vector3 } from "three";

/** Distance of the shadow from the ground, relative to the crane's size: below the grid. */
const ABOVE = 0.0008;
/** Numbers of a part in the memory of the shaders, in vectors: its place and its colour; and vectors that are needed otherwise. */
const VECTORS = { part: 5, other: 64 };

const vertexShader = `
#include <tonemapping_pars_fragment>
uniform vec3 sun, sky, earth, towards, up, haze;
uniform float near, far;
#ifdef SHADE
  uniform vec3 shade;
#endif
varying vec3 shown;
#ifdef PARTS
  uniform mat4 places[PARTS];
  uniform vec3 paints[PARTS];
  attribute float part;
#else
  uniform vec3 diffuse;
#endif
void main() {
  #ifdef PARTS
    mat4 own = places[int(part)];
    vec3 tone = paints[int(part)];
  #else
    mat4 own = mat4(1.0);
    vec3 tone = diffuse;
  #endif
  #ifdef USE_COLOR
    tone = color;
  #endif
  vec4 place = modelViewMatrix * own * vec4(position, 1.0);
  gl_Position = projectionMatrix * place;
  #ifdef SHADE
    tone = shade * mix(earth, sky, 0.5 + 0.5 * up.z) / 3.14159265;
  #elif !defined(LINE)
    vec3 direction = normalize(mat3(own) * normal);
    vec3 light = sun * max(dot(direction, towards), 0.0) + mix(earth, sky, 0.5 + 0.5 * dot(direction, up));
    tone *= light / 3.14159265;
  #endif
  tone = ACESFilmicToneMapping(tone);
  tone = mix(12.92 * tone, 1.055 * pow(tone, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, tone));
  shown = mix(tone, haze, smoothstep(near, far, -place.z));
}`;
const fragmentShader = `
uniform float opacity;
varying vec3 shown;
void main() {
  gl_FragColor = vec4(shown, opacity);
}`;

/** The geometries of meshes in one, in which every corner knows the index of its part. */
function joined(meshes) {
  const geometries = meshes.map(({ geometry }) => geometry);
  const count = (of) => geometries.reduce((sum, geometry) => sum + of(geometry), 0);
  const corners = count(({ attributes: { position } }) => position.count);
  const [position, normal] = [new Float32Array(3 * corners), new Float32Array(3 * corners)];
  const part = new Float32Array(corners);
  const index = new Uint32Array(count(({ index: own }) => own.count));
  let [corner, at] = [0, 0];
  geometries.forEach(({ attributes, index: own }, number) => {
    position.set(attributes.position.array, 3 * corner);
    normal.set(attributes.normal.array, 3 * corner);
    part.fill(number, corner, corner + attributes.position.count);
    for (const one of own.array) index[at++] = corner + one;
    corner += attributes.position.count;
  });
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(position, 3));
  geometry.setAttribute("normal", new BufferAttribute(normal, 3));
  geometry.setAttribute("part", new BufferAttribute(part, 1));
  return geometry.setIndex(new BufferAttribute(index, 1));
}

export class Plain {
  /** `ghost`: a figure behind the other one, if there is one; `vectors`: room of the shaders for numbers. */
  constructor({ figure, ghost = null, floor, grid, size, vectors }) {
    const value = (value) => ({ value });
    this.light = { sun: value(new Color()), sky: value(new Color()), earth: value(new Color()), towards: value(new Vector3()), up: value(new Vector3()), haze: value(new Color()), near: value(0), far: value(0) };
    this.floor = floor;
    this.size = size;
    this.sources = [figure, ghost].filter(Boolean).map(({ group }) => group);
    this.group = new Group();
    this.group.visible = false;
    this.shadow = new Group();
    this.shadow.matrixAutoUpdate = false;
    this.group.add(this.shadow);
    this.batches = [];
    /** Beams, whose colour may change along their lengths. */
    this.bent = [];
    const most = Math.floor((vectors - VECTORS.other) / VECTORS.part);
    this.figure(figure, this.group, most);
    this.ghost = new Group();
    if (ghost) this.figure(ghost, this.ghost, most);
    this.group.add(this.ghost);
    this.group.add(new Mesh(floor.geometry, this.material({}, { diffuse: { value: floor.material.color } })));
    this.group.children.at(-1).position.copy(floor.position);
    const lines = this.material({ LINE: "" }, { diffuse: { value: grid.material.color }, opacity: { value: grid.material.opacity } });
    lines.transparent = true;
    const squares = new LineSegments(grid.geometry, lines);
    squares.rotation.copy(grid.rotation);
    squares.position.copy(grid.position);
    this.group.add(squares);
  }

  material(defines, uniforms, more = {}) {
    return new ShaderMaterial({ vertexShader, fragmentShader, defines, uniforms: { ...this.light, opacity: { value: 1 }, toneMappingExposure: { value: 1 }, ...uniforms }, ...more });
  }

  /** The parts of a figure; `most`: so many together. */
  figure({ group, ghost }, host, most) {
    const meshes = [];
    group.traverse((one) => one.isMesh && meshes.push(one));
    const rigid = meshes.filter(({ geometry }) => !geometry.follow);
    for (let first = 0; first < rigid.length; first += most) this.batch(rigid.slice(first, first + most), host, ghost);
    for (const mesh of meshes.filter(({ geometry }) => geometry.follow)) {
      const uniforms = { diffuse: { value: mesh.material.color } };
      const drawn = this.both(mesh.geometry, {}, uniforms, host, ghost ? mesh.material : null);
      this.bent.push({ mesh, drawn, usual: drawn.material, painted: this.material({}, uniforms, { vertexColors: true }) });
    }
  }

  /** Parts that are drawn together. */
  batch(meshes, host, ghost) {
    const [places, paints] = [new Float32Array(16 * meshes.length), new Float32Array(3 * meshes.length)];
    this.batches.push({ meshes, places, paints });
    this.both(joined(meshes), { PARTS: meshes.length }, { places: { value: places }, paints: { value: paints } }, host, ghost ? meshes[0].material : null);
  }

  /** What is drawn, and its shadow; `pale`: the material of a ghost, which has none. */
  both(geometry, defines, uniforms, host, pale) {
    if (pale) {
      const { transparent, opacity, depthWrite, polygonOffset, polygonOffsetFactor, polygonOffsetUnits } = pale;
      const look = { transparent, depthWrite, polygonOffset, polygonOffsetFactor, polygonOffsetUnits };
      const mesh = new Mesh(geometry, this.material(defines, { ...uniforms, opacity: { value: opacity } }, look));
      mesh.frustumCulled = false;
      host.add(mesh);
      return mesh;
    }
    const mesh = new Mesh(geometry, this.material(defines, uniforms));
    const shade = new Mesh(geometry, this.material({ ...defines, SHADE: "" }, { ...uniforms, shade: { value: this.floor.material.color } }));
    mesh.frustumCulled = shade.frustumCulled = false;
    host.add(mesh);
    this.shadow.add(shade);
    return mesh;
  }

  /** Shows the crane plainly, with its ghost or without. */
  show(shown, ghostly) {
    this.group.visible = shown;
    this.ghost.visible = ghostly;
    if (shown) this.follow();
  }

  /** The light of a scene: of the sun, of sky and earth, and its haze. */
  lit(sun, sky, fog) {
    const { light } = this;
    light.sun.value.copy(sun.color).multiplyScalar(sun.intensity);
    light.sky.value.copy(sky.color).multiplyScalar(sky.intensity);
    light.earth.value.copy(sky.groundColor).multiplyScalar(sky.intensity);
    light.towards.value.subVectors(sun.position, sun.target.position).normalize();
    light.up.value.copy(sky.position).normalize();
    // As the screen shows it.
    light.haze.value.copy(fog.color).convertLinearToSRGB();
    light.near.value = fog.near;
    light.far.value = fog.far;
    // Flattens along the light.
    const { x, y, z } = light.towards.value;
    const level = this.floor.position.z + ABOVE * this.size;
    this.shadow.matrix.set(1, 0, -x / z, (x / z) * level, 0, 1, -y / z, (y / z) * level, 0, 0, 0, level, 0, 0, 0, 1);
    this.shadow.matrixWorldNeedsUpdate = true;
  }

  /** Takes the places and the colours of all parts. */
  follow() {
    for (const source of this.sources) source.updateMatrixWorld();
    for (const { mesh, drawn, usual, painted } of this.bent) {
      drawn.material = mesh.material.vertexColors ? painted : usual;
      usual.uniforms.diffuse.value = mesh.material.color;
    }
    for (const { meshes, places, paints } of this.batches) {
      meshes.forEach(({ matrixWorld, material: { color } }, index) => {
        places.set(matrixWorld.elements, 16 * index);
        color.toArray(paints, 3 * index);
      });
    }
  }
}
