"""CIEDE2000 of the quadratures over the ColorChecker against the sum at 1 nm, light as emitted; prints mean and
largest. Expected values of the tests of src/spectra/quadrature.rs; colour-science 0.4.7, numpy."""
import numpy as np, colour
M2=np.array([[-.0177,1.0090,.0073],[-1.5370,1.0821,.3209],[.1946,-.2045,.5264]]); inv=np.linalg.inv(M2)
cm=colour.MSDS_CMFS['CIE 1931 2 Degree Standard Observer']; lam=cm.wavelengths; ACC=cm.values@M2.T; Y=cm.values[:,1].sum()
cc=colour.SDS_COLOURCHECKERS['ColorChecker N Ohta']
R=np.array([np.interp(lam,s.wavelengths,s.values) for s in cc.values()])
# Meyer (1988): C2 one-point Gauss; C1 two-point Gauss; A these two and the middle node of its three-point rule.
MEYER = (np.array([456.3888619518867, 490.8709164835706, 557.7843820460529, 631.4530956493448]),
         np.array([[0, .17878208405191182, .6380947671284947, .18172414606173068],
                   [0, .30082383087985304, 0, -.4348407346377654], [.5166896386902587, 0, 0, 0]]))
def box(N):
    e=np.linspace(400,700,N+1); lo=e[:-1].copy();hi=e[1:].copy();lo[0]=0;hi[-1]=9999
    return (e[1:]+e[:-1])/2, np.array([[ACC[(lam>=l)&(lam<h),k].sum() for l,h in zip(lo,hi)] for k in range(3)])/Y
for name,(n,W) in {'8':box(8),'16':box(16),'4':MEYER}.items():
    for ln in ('E','D65','A'):
        E=colour.SDS_ILLUMINANTS[ln].copy().align(cm.shape).values
        s=Y/(E*cm.values[:,1]).sum(); E=E*s
        ref=(R*E)@ACC/Y; Wr=inv@((E[:,None]*ACC).sum(0)/Y)
        S=np.array([np.interp(n,lam,r)*np.interp(n,lam,E) for r in R])@W.T
        xyw=colour.XYZ_to_xy(Wr)
        L=[colour.XYZ_to_Lab(np.clip(x@inv.T/Wr[1],0,None),xyw) for x in (S,ref)]
        d=colour.delta_E(L[0],L[1],method='CIE 2000'); print(name,ln,repr(d.mean()),repr(d.max()))
