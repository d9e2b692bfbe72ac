// NAFEMS FV2, "pin-ended double cross": eight arms of 5 m at 45 degrees in the x-y plane, n cells an arm.
DefineConstant[n = 8];
arm = 5;
d = arm * Sqrt(0.5);
xs[] = {arm, d, 0, -d, -arm, -d, 0, d};
ys[] = {0, d, arm, d, 0, -d, -arm, -d};
Point(1) = {0, 0, 0};
ends[] = {}; arms[] = {};
For i In {0 : 7}
  out[] = Extrude {xs[i], ys[i], 0} { Point{1}; Layers{n}; };  // end point, curve
  ends[] += out[0];
  arms[] += out[1];
EndFor
Physical Point("centre") = {1};
Physical Point("ends") = {ends[]};
Physical Curve("arms") = {arms[]};
