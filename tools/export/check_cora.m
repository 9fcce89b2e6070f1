% Evaluates exported CORA functions in the current folder at the points of check_points.csv and
% compares them with our derivatives; exits with 1 where they differ.
data = cora_data();
points = csvread('check_points.csv', 1, 0);
states = numel(data.x_start);
inputs = numel(data.U_centre);
worst = 0;
for k = 1:rows(points)
  x = points(k, 1:states)';
  u = points(k, states+1:states+inputs)';
  ours = points(k, states+inputs+1:end)';
  worst = max(worst, max(abs(cora_dynamics(x, u) - ours) ./ max(1, abs(ours))));
  if isfield(data, 'A')
    matrices = data.A * x + data.B * u + data.c;
    worst = max(worst, max(abs(matrices - ours) ./ max(1, abs(ours))));
  end
end
% The comparison finds bounds that are ours, wider, and narrower.
table = csvread('bounds.csv', 1, 0);
names = (columns(table) - 1) / 3;
lower = table(:, 2:3:3*names-1);
upper = table(:, 4:3:3*names+1);
width = upper - lower;
[outside, ratio] = cora_compare(lower, upper);
compares = outside == 0 && abs(ratio - 1) < 1e-12;
[outside, ratio] = cora_compare(lower - 0.25*width, upper + 0.25*width);
compares = compares && outside == 0 && abs(ratio - 1.5) < 1e-9;
[outside, ratio] = cora_compare(lower + 0.1*width, upper);
compares = compares && abs(outside - 0.1) < 1e-9;
held = isfield(data, 'u') && isequal(size(data.u), [inputs, data.steps]);
printf('%s: %d states, %d points: derivatives differ by %.1e at most\n', ...
       pwd(), states, rows(points), worst);
exit(~(worst < 1e-12 && held && compares && rows(points) == 1000));
