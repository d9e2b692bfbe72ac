// NAFEMS FV4, "cantilever with off-centre point masses": a beam of 10 m along x, n cells, and two points 2 m beside its
// tip in y, which belong to no cell of the beam: rigid arms join them to the tip.
DefineConstant[n = 16];
Point(1) = {0, 0, 0}; Point(2) = {10, 2, 0}; Point(3) = {10, -2, 0};
beam[] = Extrude {10, 0, 0} { Point{1}; Layers{n}; };  // end point, curve
Physical Point("root") = {1};
Physical Point("tip") = {beam[0]};
Physical Point("tip_plus") = {2};
Physical Point("tip_minus") = {3};
Physical Curve("beam") = {beam[1]};
