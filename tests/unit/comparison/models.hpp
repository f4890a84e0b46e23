#pragma once
#include <string>

namespace models {

inline const std::string cartesian_pendulum = R"(system cartesian
param m = 1 kg, l = 2 m, g = 9.81 m/s^2
coord x, y : length
point P mass m at (x, y)
gravity (0, -g)
constraint x^2 + y^2 = l^2 name rod
start x = 1 m, y' = 0, y = -1.7320508075688772 m
run 3 s
expect reaction rod at 0 s = 8.495709211125344 N rel 1e-12
)";

inline const std::string angle_pendulum = R"(system polar
param m = 1 kg, l = 2 m, g = 9.81 m/s^2
coord θ : angle
T = 1/2 m l^2 θ'^2
V = -m g l cos θ
start θ = 30 deg
run 5 s
)";

inline const std::string spherical_cartesian = R"(system spherical_cartesian
param m = 1 kg, l = 1 m, g = 9.81 m/s^2
coord x, y, z : length
T = 1/2 m (x'^2 + y'^2 + z'^2)
V = m g z
constraint sqrt(x^2 + y^2 + z^2) = l name rod
start x = 0.6 m, y' = 1 m/s, z = -0.8 m
run 2 s
expect freedoms = 2
expect conserved m (x y' - y x')
)";

inline const std::string atwood = R"(system atwood
param m1 = 1 kg, m2 = 2 kg, l = 3 m, g = 9.81 m/s^2
coord y1, y2 : length    # heights
T = 1/2 m1 y1'^2 + 1/2 m2 y2'^2
V = m1 g y1 + m2 g y2
constraint y1 + y2 = -l name string
start y1 = -1 m
run 1 s
)";

inline const std::string planetary_gear = R"(system planetary_gear
param Rs = 20 mm, Rp = 15 mm, n = 3, mp = 50 g, τ = 0.1 N m
param Is = 1e-5 kg m^2, Ip = 4e-6 kg m^2, Ic = 8e-5 kg m^2
coord φs, φp, φc, φr : angle           # sun, planet, carrier, ring
let Rr = Rs + 2 Rp, a = Rs + Rp
T = 1/2 Is φs'^2 + n/2 Ip φp'^2 + 1/2 (Ic + n mp a^2) φc'^2
constraint Rs (φs - φc) = -Rp (φp - φc)
constraint Rr (φr - φc) =  Rp (φp - φc)
constraint φr = 0                      # ring held
force φs = τ
run 1 s
)";

inline const std::string bead_on_parabola = R"(system bead
param m = 1 kg, k = 2 /m, g = 9.81 m/s^2
coord x, y : length
point P mass m at (x, y)
gravity (0, -g)
constraint y = k x^2 name wire
start x = 1 m
run 2 s
draw trail P, reaction wire
)";

inline const std::string double_pendulum = R"(system double
param m1 = 1 kg, m2 = 1 kg, l1 = 1 m, l2 = 1 m, g = 9.81 m/s^2
coord x1, y1, x2, y2 : length
point A mass m1 at (x1, y1)
point B mass m2 at (x2, y2)
gravity (0, -g)
constraint norm(A) = l1 name r1
constraint norm(B - A) = l2 name r2
start x1 = l1, x2 = 1 m, y2 = -1 m
run 2 s
)";

inline const std::string four_bar = R"(system fourbar
param m = 1 kg, a = 1 m, b = 2 m, c = 2 m, d = 2 m, g = 9.81 m/s^2
coord α, β, γ : angle
point A mass m at a (cos α, sin α)
point B mass m at A + b (cos β, sin β)
gravity (0, -g)
constraint a cos α + b cos β - c cos γ = d
constraint a sin α + b sin β = c sin γ
start α = 60 deg
run 1 s
)";

inline const std::string rolling_disk = R"(system rolling_disk
param m = 1 kg, R = 20 cm
let I = 1/2 m R^2, J = 1/4 m R^2
coord x, y : length
coord φ, ψ : angle
T = 1/2 m (x'^2 + y'^2) + 1/2 I φ'^2 + 1/2 J ψ'^2
constraint x' = R φ' cos ψ
constraint y' = R φ' sin ψ
start φ' = 2 rad/s, ψ' = 1 rad/s
run 2 s
)";

}  // namespace models
