"""Units as multiples of the SI: ``2.4 * units.kN_per_m3`` is a unit weight in N/m3.

The values are exact by definition: NIST Special Publication 811 (2008), Appendix B; 1 in = 0.0254 m,
1 lb = 0.45359237 kg, standard gravity 9.80665 m/s2. The weight of a mass is ``mass * units.gravity``.
"""

from math import pi as _pi

# length, m
m = 1.0
mm = 1e-3
cm = 1e-2
inch = 0.0254
ft = 0.3048

# mass, kg
kg = 1.0
t = 1e3
lb = 0.45359237

#: Standard gravity, m/s2.
gravity = 9.80665

# force, N
N = 1.0
kN = 1e3
MN = 1e6
kgf = gravity
lbf = lb * gravity
kip = 1e3 * lbf

# stress, Pa
Pa = 1.0
kPa = 1e3
MPa = 1e6
psi = lbf / inch**2
ksi = 1e3 * psi
psf = lbf / ft**2

# unit weight, N/m3
N_per_m3 = 1.0
kN_per_m3 = 1e3
kgf_per_m3 = kgf
pcf = lbf / ft**3

# angle, rad
deg = _pi / 180
