% Writes an array of ProbingData objects or structs (fields ContactPoint, ContactSurfNorm,
% ContactBallCenter, CurrentPos, DeformedForce, Fail) as a CSV that hs-import understands.
%   probing = load('region.mat'); write_probing(probing.<its array>, 'region.csv')
% Not run by hapsim's tests: it needs MATLAB.
function write_probing(sites, file)
  out = fopen(file, 'w');
  vectors = {'ContactPoint', 'ContactSurfNorm', 'ContactBallCenter'};
  fprintf(out, 'site,depth_index');
  for name = [vectors, {'CurrentPos', 'DeformedForce'}]
    fprintf(out, ',%s_x,%s_y,%s_z', name{1}, name{1}, name{1});
  end
  fprintf(out, ',Fail\n');
  for i = 1:numel(sites)
    s = sites(i);
    for k = 1:size(s.CurrentPos, 1)
      row = [i, k];
      for name = vectors, row = [row, reshape(s.(name{1}), 1, 3)]; end %#ok<AGROW>
      row = [row, s.CurrentPos(k, :), s.DeformedForce(k, :), any(s.Fail)]; %#ok<AGROW>
      fprintf(out, '%.9g,', row(1:end-1));
      fprintf(out, '%.9g\n', row(end));
    end
  end
  fclose(out);
end
