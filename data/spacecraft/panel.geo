// A solar array wing: an A-shaped yoke of beams from the root at the origin, then three panels of 1.6 m x 2.0 m one
// behind the other along +y, in the x-y plane, hinged to the yoke and to each other across gaps of 5 cm.
//
//   root --stem-- + ==leg== hinge [ panel 1 ] hinge [ panel 2 ] hinge [ panel 3 ] tip    --> y
//
// n cells across a panel's width (a multiple of 10, so that hinges fall on nodes); 5/4 n along its length.
DefineConstant[n = 20];
width = 1.6; length = 2.0; gap = 0.05;
hinge_x = 0.64;                 // of the outer hinges, from the middle line
stem = 0.4; yoke_end = 1.4;     // y of the yoke's fork and of its ends

// --- yoke
root = newp; Point(root) = {0, 0, 0};
fork = newp; Point(fork) = {0, stem, 0};
yoke[] = {};
l = newc; Line(l) = {root, fork}; Transfinite Curve {l} = 4 + 1; yoke[] += l;
For side In {0 : 1}
  x = (2 * side - 1) * hinge_x;
  knee~{side} = newp; Point(knee~{side}) = {x / 2, (stem + yoke_end) / 2, 0};
  end~{side} = newp; Point(end~{side}) = {x, yoke_end, 0};
  l = newc; Line(l) = {fork, knee~{side}}; Transfinite Curve {l} = 6 + 1; yoke[] += l;
  l = newc; Line(l) = {knee~{side}, end~{side}}; Transfinite Curve {l} = 6 + 1; yoke[] += l;
EndFor
l = newc; Line(l) = {knee_0, knee_1}; Transfinite Curve {l} = 6 + 1; yoke[] += l;

// --- panels; each cross edge is divided at the three hinge positions
skin[] = {}; frame[] = {}; hinge[] = {};
cells[] = {n / 10, 4 * n / 10, 4 * n / 10, n / 10};
xs[] = {-width / 2, -hinge_x, 0, hinge_x, width / 2};
For k In {0 : 2}
  y0 = yoke_end + gap + k * (length + gap);
  For i In {0 : 4}
    near~{i} = newp; Point(near~{i}) = {xs[i], y0, 0};
  EndFor
  If (k == 0)
    l = newc; Line(l) = {end_0, near_1}; hinge[] += l;
    l = newc; Line(l) = {end_1, near_3}; hinge[] += l;
  Else
    For i In {1 : 3}
      l = newc; Line(l) = {far~{i}, near~{i}}; hinge[] += l;
    EndFor
  EndIf
  For i In {0 : 4}
    far~{i} = newp; Point(far~{i}) = {xs[i], y0 + length, 0};
  EndFor
  near_edge[] = {}; far_edge[] = {};
  For i In {0 : 3}
    l = newc; Line(l) = {near~{i}, near~{i + 1}}; Transfinite Curve {l} = cells[i] + 1; near_edge[] += l;
    l = newc; Line(l) = {far~{i}, far~{i + 1}}; Transfinite Curve {l} = cells[i] + 1; far_edge[] += l;
  EndFor
  left = newc; Line(left) = {near_0, far_0};
  right = newc; Line(right) = {near_4, far_4};
  Transfinite Curve {left, right} = 5 * n / 4 + 1;
  loop = newll; Curve Loop(loop) = {near_edge[], right, -far_edge[3], -far_edge[2], -far_edge[1], -far_edge[0], -left};
  s = news; Plane Surface(s) = {loop};
  Transfinite Surface {s} = {near_0, near_4, far_4, far_0};
  Recombine Surface {s};
  skin[] += s;
  frame[] += {near_edge[], far_edge[], left, right};
EndFor
Transfinite Curve {hinge[]} = 2;

Physical Point("root") = {root};
Physical Point("tip") = {far_2};
Physical Curve("yoke") = {yoke[]};
Physical Curve("frame") = {frame[]};
Physical Curve("hinge") = {hinge[]};
Physical Surface("skin") = {skin[]};
