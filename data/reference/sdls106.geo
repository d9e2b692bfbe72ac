// SDLS106: a plate 2.0 m x 1.5 m, n cells on the shorter side (a multiple of 2), cut at x = 0.75 m. part = 0 saves the
// whole, 1 and 2 save the piece left and right of the cut: the same nodes, those of the cut in both.
DefineConstant[n = 24, part = 0];
a = 2.0; b = 1.5; c = 0.75;
Point(1) = {0, 0, 0};
left[] = Extrude {c, 0, 0} { Point{1}; Layers{Round(n * c / b)}; };  // end point, curve
right[] = Extrude {a - c, 0, 0} { Point{left[0]}; Layers{Round(n * (a - c) / b)}; };
one[] = Extrude {0, b, 0} { Curve{left[1]}; Layers{n}; Recombine; };  // top, surface, end side, start side
two[] = Extrude {0, b, 0} { Curve{right[1]}; Layers{n}; Recombine; };
Physical Curve("cut") = {Abs(one[2])};
If (part != 2)
  Physical Curve("x0") = {Abs(one[3])};
EndIf
If (part != 1)
  Physical Curve("x1") = {Abs(two[2])};
EndIf
If (part == 0)
  Physical Curve("y0") = {left[1], right[1]}; Physical Curve("y1") = {one[0], two[0]};
  Physical Surface("plate") = {one[1], two[1]};
ElseIf (part == 1)
  Physical Curve("y0") = {left[1]}; Physical Curve("y1") = {one[0]};
  Physical Surface("plate") = {one[1]};
Else
  Physical Curve("y0") = {right[1]}; Physical Curve("y1") = {two[0]};
  Physical Surface("plate") = {two[1]};
EndIf
