(A letter A, 12 mm wide and 18 mm high)
G17 G21 G90
G00 X-6. Y-36. S20000 M03
Z5.
G01 Z-0.3 F600.
X0. Y-18.
X6. Y-36.
G00 Z5.
X-4. Y-30.
G01 Z-0.3
X4.
G00 Z20.
M30
