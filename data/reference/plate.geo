// A plate a x b in the x-y plane, b the shorter side with n cells, cells as square as that allows.
DefineConstant[a = 1.5, b = 1, n = 24];
Point(1) = {0, 0, 0};
bottom[] = Extrude {a, 0, 0} { Point{1}; Layers{Round(n * a / b)}; };
plate[] = Extrude {0, b, 0} { Curve{bottom[1]}; Layers{n}; Recombine; };  // top, surface, sides
Physical Curve("x0") = {Abs(plate[3])};
Physical Curve("x1") = {Abs(plate[2])};
Physical Curve("y0") = {bottom[1]};
Physical Curve("y1") = {plate[0]};
Physical Surface("plate") = {plate[1]};
