// Least time of rnea, aba and crba of Pinocchio for a chain of six joints, ns, one per line.
#include <pinocchio/multibody.hpp>
#include <pinocchio/algorithm/aba.hpp>
#include <pinocchio/algorithm/crba.hpp>
#include <pinocchio/algorithm/rnea.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <vector>

using Vector = Eigen::VectorXd;

template <typename Call>
double least(Call call) {
  double best = 1e9;
  for (int round = 0; round < 15; round++) {
    const auto begin = std::chrono::steady_clock::now();
    for (int k = 0; k < 20000; k++) call(k % 256);
    const std::chrono::duration<double, std::nano> took = std::chrono::steady_clock::now() - begin;
    best = std::min(best, took.count() / 20000);
  }
  return best;
}

int main() {
  pinocchio::Model model;
  std::srand(1);
  for (int i = 0; i < 6; i++) {
    const auto joint = model.addJoint(i, pinocchio::JointModelRZ(), pinocchio::SE3::Random(),
                                      "joint" + std::to_string(i));
    model.appendBodyToJoint(joint, pinocchio::Inertia::Random(), pinocchio::SE3::Identity());
  }
  pinocchio::Data data(model);
  std::vector<Vector> q, v, a;
  for (int k = 0; k < 256; k++) {
    q.push_back(3.1 * Vector::Random(6));
    v.push_back(Vector::Random(6));
    a.push_back(Vector::Random(6));
  }
  double sink = 0;
  std::printf("%f\n", least([&](int k) { sink += pinocchio::rnea(model, data, q[k], v[k], a[k])[0]; }));
  std::printf("%f\n", least([&](int k) { sink += pinocchio::aba(model, data, q[k], v[k], a[k])[0]; }));
  std::printf("%f\n", least([&](int k) { sink += pinocchio::crba(model, data, q[k])(0, 0); }));
  std::fprintf(stderr, "%g\n", sink);
}
