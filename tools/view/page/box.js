// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The edges of the domain, a box, and those where a plane leaves it.
import * as THREE from './three.module.js';

/** Pairs of points, one an edge. */
export function boxEdges([low, high]) {
  const corner = (bits) => new THREE.Vector3(
    ...low.map((x, d) => (bits >> d & 1 ? high[d] : x)));
  const edges = [];
  for (let bits = 0; bits < 8; ++bits) {
    for (let d = 0; d < 3; ++d) if (!(bits >> d & 1)) edges.push([corner(bits), corner(bits | 1 << d)]);
  }
  return edges;
}

/** The polygon of { point, normal } in a box, as pairs of points; empty where the plane misses it. */
export function planeEdges(box, { point, normal }) {
  const plane = new THREE.Plane().setFromNormalAndCoplanarPoint(
    new THREE.Vector3(...normal).normalize(), new THREE.Vector3(...point));
  const points = boxEdges(box)
    .map(([a, b]) => plane.intersectLine(new THREE.Line3(a, b), new THREE.Vector3()))
    .filter((x) => x);
  if (points.length < 3) return [];
  // In order around their middle.
  const middle = points.reduce((sum, x) => sum.add(x), new THREE.Vector3()).divideScalar(points.length);
  const right = points[0].clone().sub(middle);
  const up = right.clone().cross(plane.normal);
  const angle = (x) => Math.atan2(x.clone().sub(middle).dot(up), x.clone().sub(middle).dot(right));
  points.sort((a, b) => angle(a) - angle(b));
  return points.flatMap((x, i) => [x, points[(i + 1) % points.length]]);
}
