behavior_name=yo
<end:b_arg>
<start:b_arg>
<start:waypoints>
<middle> x
1 2
<start:waypoints>
b_arg x
