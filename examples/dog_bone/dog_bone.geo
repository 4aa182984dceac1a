// A dog bone with two pin holes, in mm; written in m: gmsh -2 dog_bone.geo -format msh41
h = 2;
Point(1)={-50,-15,0,h}; Point(2)={-30,-15,0,h}; Point(3)={-20,-10,0,h}; Point(4)={20,-10,0,h}; Point(5)={30,-15,0,h}; Point(6)={50,-15,0,h};
Point(7)={50,15,0,h}; Point(8)={30,15,0,h}; Point(9)={20,10,0,h}; Point(10)={-20,10,0,h}; Point(11)={-30,15,0,h}; Point(12)={-50,15,0,h};
Line(1)={1,2}; Line(2)={2,3}; Line(3)={3,4}; Line(4)={4,5}; Line(5)={5,6}; Line(6)={6,7}; Line(7)={7,8}; Line(8)={8,9}; Line(9)={9,10}; Line(10)={10,11}; Line(11)={11,12}; Line(12)={12,1};
Point(20)={-40,0,0,h}; Point(21)={-36,0,0,h}; Point(22)={-44,0,0,h}; Circle(21)={21,20,22}; Circle(22)={22,20,21};
Point(30)={40,0,0,h}; Point(31)={44,0,0,h}; Point(32)={36,0,0,h}; Circle(31)={31,30,32}; Circle(32)={32,30,31};
Line Loop(1)={1,2,3,4,5,6,7,8,9,10,11,12}; Line Loop(2)={21,22}; Line Loop(3)={31,32};
Plane Surface(1)={1,2,3};
Physical Surface("body")={1}; Physical Curve("left pin")={21,22}; Physical Curve("right pin")={31,32}; Physical Curve("waist")={3,9};
Mesh.ScalingFactor = 0.001;
