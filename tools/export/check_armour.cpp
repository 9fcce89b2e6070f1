// Reads the header of an arm as the planner ARMOUR includes it, and compares the torques of its
// numbers with ours.
//
//     g++ -I FOLDER_OF_RobotInfo.h -o check_armour check_armour.cpp
//     ./check_armour check_torques.csv
//
// The recursion of Newton and Euler is evaluated in the frames of the header: R = Rx(roll) Ry(pitch)
// Rz(yaw), then the turn about the axis.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

using namespace std;  // The header is written for this.

#include "RobotInfo.h"

using Vector = array<double, 3>;
using Matrix = array<Vector, 3>;

static Vector operator+(const Vector& a, const Vector& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
static Vector operator*(double s, const Vector& a) { return {s * a[0], s * a[1], s * a[2]}; }
static Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
static Vector operator*(const Matrix& m, const Vector& v) {
  Vector w{};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) w[i] += m[i][j] * v[j];
  return w;
}
static Matrix operator*(const Matrix& a, const Matrix& b) {
  Matrix c{};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      for (int k = 0; k < 3; k++) c[i][j] += a[i][k] * b[k][j];
  return c;
}
static Matrix transposed(const Matrix& a) {
  Matrix b{};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) b[i][j] = a[j][i];
  return b;
}
static Matrix turn(int axis, double angle) {
  const int i = (axis + 1) % 3, j = (axis + 2) % 3;
  Matrix r{};
  r[axis][axis] = 1;
  r[i][i] = r[j][j] = cos(angle);
  r[i][j] = -sin(angle);
  r[j][i] = sin(angle);
  return r;
}
static Vector at(const double* values, int i) {
  return {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
}

static vector<double> torques(const double* q, const double* qd, const double* qdd) {
  vector<Matrix> rotations;
  vector<Vector> forces, moments;
  Vector w{}, wdot{}, a{0, 0, gravity};
  for (int i = 0; i < NUM_JOINTS; i++) {
    const int axis = axes[i] - 1;
    const Matrix fixed = turn(0, rots[3 * i]) * turn(1, rots[3 * i + 1]) * turn(2, rots[3 * i + 2]);
    const Matrix r = fixed * turn(axis, q[i]), back = transposed(r);
    const Vector p = at(trans, i);
    a = back * (a + cross(wdot, p) + cross(w, cross(w, p)));
    Vector rate{}, rise{};
    rate[axis] = qd[i];
    rise[axis] = qdd[i];
    const Vector before = back * w;
    w = before + rate;
    wdot = back * wdot + cross(before, rate) + rise;
    const Vector c = at(com, i);
    forces.push_back(mass[i] * (a + cross(wdot, c) + cross(w, cross(w, c))));
    Matrix tensor;
    for (int j = 0; j < 9; j++) tensor[j / 3][j % 3] = inertia[9 * i + j];
    moments.push_back(tensor * wdot + cross(w, tensor * w) + cross(c, forces.back()));
    rotations.push_back(r);
  }
  vector<double> tau(NUM_JOINTS);
  Vector force{}, moment{};
  for (int i = NUM_JOINTS - 1; i >= 0; i--) {
    if (i + 1 < NUM_JOINTS) {
      const Vector shifted = rotations[i + 1] * force;
      moment = moments[i] + rotations[i + 1] * moment + cross(at(trans, i + 1), shifted);
      force = forces[i] + shifted;
    } else {
      moment = moments[i];
      force = forces[i];
    }
    tau[i] = moment[axes[i] - 1] + armature[i] * qdd[i];
  }
  return tau;
}

int main(int count, char** arguments) {
  if (count != 2) return 2;
  ifstream file(arguments[1]);
  string line;
  getline(file, line);
  double worst = 0, largest = 0;
  int rows = 0;
  while (getline(file, line)) {
    stringstream cells(line);
    vector<double> row;
    for (string cell; getline(cells, cell, ',');) row.push_back(stod(cell));
    if (row.size() != 4 * NUM_JOINTS) return 2;
    const double* x = row.data();
    const vector<double> tau = torques(x, x + NUM_JOINTS, x + 2 * NUM_JOINTS);
    for (int i = 0; i < NUM_JOINTS; i++) {
      worst = max(worst, abs(tau[i] - x[3 * NUM_JOINTS + i]));
      largest = max(largest, abs(tau[i]));
    }
    rows++;
  }
  const bool bounds = 0 < M_min && M_min < M_max && 0 < eps && isfinite(qe + qde + qdae + qddae);
  bool limits = bounds && alpha > 0 && mass_uncertainty >= 0 && inertia_uncertainty >= 0;
  for (int i = 0; i < NUM_FACTORS; i++) {
    limits = limits && state_limits_lb[i] < state_limits_ub[i] && speed_limits[i] > 0 &&
             torque_limits[i] > 0 && friction[i] >= 0 && damping[i] >= 0;
    for (int k = 0; k < 3; k++)
      limits = limits && isfinite(link_zonotope_center[i][k]) && link_zonotope_generators[i][k] > 0;
  }
  printf("%s: %d joints of ARMOUR, M within %.4g to %.4g kg m^2, ultimate bound %.3g, torques at %d "
         "states to %.1e N m of %.0f\n",
         arguments[1], NUM_JOINTS, M_min, M_max, eps, rows, worst, largest);
  return rows > 0 && limits && com_uncertainty == 0 && worst < 1e-9 ? 0 : 1;
}
