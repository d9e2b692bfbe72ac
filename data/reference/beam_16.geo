// A unit line along x of n cells: beams with all pairs of end conditions.
DefineConstant[n = 16];
Point(1) = {0, 0, 0};
beam[] = Extrude {1, 0, 0} { Point{1}; Layers{n}; };  // end point, curve
Physical Point("left") = {1};
Physical Point("right") = {beam[0]};
Physical Curve("beam") = {beam[1]};
